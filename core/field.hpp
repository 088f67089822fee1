#pragma once
// One value per cell (or per face, or per corner: the low one of the cell), with ghost layers.
#include <string>

#include "core/grid.hpp"
#include "core/large_pages.hpp"
#include "core/types.hpp"

namespace peclet {

/// Cheap to copy: copies share their memory.
template <class T>
class Field {
 public:
  Field() = default;
  /// Zero everywhere, ghosts included.
  Field(const std::string& name, const Layout& layout)
      : layout_(layout), data_(array_in_large_pages<T>(name, layout.size)) {}

  KOKKOS_INLINE_FUNCTION T& operator()(int i, int j, int k) const { return data_.data()[layout_(i, j, k)]; }
  KOKKOS_INLINE_FUNCTION T& operator[](Index n) const { return data_.data()[n]; }

  KOKKOS_INLINE_FUNCTION const Layout& layout() const { return layout_; }
  KOKKOS_INLINE_FUNCTION T* data() const { return data_.data(); }
  const Array<T>& array() const { return data_; }
  bool is_allocated() const { return data_.extent(0) > 0; }
  void fill(T value) const { Kokkos::deep_copy(data_, value); }

 private:
  Layout layout_;
  Array<T> data_;
};

/// Three face-normal components; component a of cell (i, j, k) lives on the low face along axis a.
template <class T>
struct FaceVector {
  Field<T> x, y, z;

  FaceVector() = default;
  FaceVector(const std::string& name, const Layout& layout)
      : x(name + ".x", layout), y(name + ".y", layout), z(name + ".z", layout) {}
  KOKKOS_INLINE_FUNCTION const Field<T>& operator[](int axis) const {
    return axis == 0 ? x : (axis == 1 ? y : z);
  }
};

}  // namespace peclet
