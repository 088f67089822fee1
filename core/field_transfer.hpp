#pragma once
// Copies between host memory and arrays or fields where kernels run.
#include <string>
#include <vector>

#include "core/field.hpp"
#include "core/loop.hpp"

namespace peclet {

/// Copy of size values for kernels.
template <class T>
Array<T> copy_from_host(const std::string& label, const T* values, Index size) {
  const Kokkos::View<const T*, Kokkos::HostSpace> source(values, size);
  Array<T> copy(Kokkos::view_alloc(label, Kokkos::WithoutInitializing), size);
  Kokkos::deep_copy(copy, source);
  return copy;
}

template <class T>
Array<T> copy_from_host(const std::string& label, const std::vector<T>& values) {
  return copy_from_host(label, values.data(), static_cast<Index>(values.size()));
}

/// Copies values for kernels into an array, which grows when it is too small.
template <class T>
void upload(const std::string& name, const std::vector<T>& values, Array<T>& device) {
  if (device.extent(0) < values.size()) device = Array<T>(name, values.size() + values.size() / 2 + 16);
  if (values.empty()) return;
  const Kokkos::View<const T*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> host(
      values.data(), values.size());
  Kokkos::deep_copy(Kokkos::subview(device, Kokkos::pair<std::size_t, std::size_t>(0, values.size())), host);
}

template <class T>
void copy_to_host(const Array<T>& array, T* values) {
  Kokkos::deep_copy(Kokkos::View<T*, Kokkos::HostSpace>(values, array.extent(0)), array);
}

template <class T>
std::vector<T> copy_to_host(const Array<T>& array) {
  std::vector<T> values(array.extent(0));
  copy_to_host(array, values.data());
  return values;
}

/// Values of the cells of a box (ghosts may be among them), x fastest.
template <class T>
void copy_to_host(const Field<T>& field, const Box& box, T* values) {
  const Index size = box.size();
  const Array<T> dense = runs_on_host
                             ? Array<T>(values, size)
                             : Array<T>(Kokkos::view_alloc("core::dense", Kokkos::WithoutInitializing), size);
  for_each_cell(
      "core::copy_to_host", box, KOKKOS_LAMBDA(int i, int j, int k) {
        dense(i - box.low[0] +
              box.extent(0) * (j - box.low[1] + static_cast<Index>(box.extent(1)) * (k - box.low[2]))) =
            field(i, j, k);
      });
  if (runs_on_host)
    Kokkos::fence("core::copy_to_host");
  else
    copy_to_host(dense, values);
}

/// The cells of a field: values[i + nx (j + ny k)] = field(i, j, k)
template <class T>
void copy_to_host(const Field<T>& field, T* values) {
  copy_to_host(field, Box{{0, 0, 0}, field.layout().cells}, values);
}

/// Overwrites the cells of a box; the rest of the field stays as it is.
template <class T>
void copy_from_host(const T* values, const Box& box, const Field<T>& field) {
  const Array<T> dense = copy_from_host("core::dense", values, box.size());
  for_each_cell(
      "core::copy_from_host", box, KOKKOS_LAMBDA(int i, int j, int k) {
        field(i, j, k) =
            dense(i - box.low[0] +
                  box.extent(0) * (j - box.low[1] + static_cast<Index>(box.extent(1)) * (k - box.low[2])));
      });
  Kokkos::fence("core::copy_from_host");
}

/// field(i, j, k) = values[i + nx (j + ny k)]; ghosts stay as they are.
template <class T>
void copy_from_host(const T* values, const Field<T>& field) {
  copy_from_host(values, Box{{0, 0, 0}, field.layout().cells}, field);
}

}  // namespace peclet
