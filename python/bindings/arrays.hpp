#pragma once
// The only place where NumPy arrays and C++ meet. Inputs may have any real dtype, memory order and strides:
// they are converted, keeping values and index meaning. Outputs own their memory.
#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

#include "core/error.hpp"
#include "core/field.hpp"
#include "core/field_transfer.hpp"
#include "core/vec3.hpp"

namespace peclet::python {

namespace nb = nanobind;

enum class Order : char { C = 'C', Fortran = 'F' };

/// Allowed extents per axis; any_size accepts every number.
using Shape = std::vector<std::int64_t>;
inline constexpr std::int64_t any_size = -1;

namespace detail {

inline bool accept(PyObject*) { return true; }

template <class T>
struct Dtype;  // NumPy's name of the element type
template <>
struct Dtype<double> {
  static constexpr char name[] = "float64";
};
template <>
struct Dtype<float> {
  static constexpr char name[] = "float32";
};
template <>
struct Dtype<std::int32_t> {
  static constexpr char name[] = "int32";
};
template <>
struct Dtype<std::int64_t> {
  static constexpr char name[] = "int64";
};
template <>
struct Dtype<std::uint8_t> {
  static constexpr char name[] = "uint8";
};

inline std::string shape_text(const Shape& shape) {
  std::string text = "(";
  for (std::size_t n = 0; n < shape.size(); ++n)
    text += (n ? ", " : "") + (shape[n] == any_size ? std::string("*") : std::to_string(shape[n]));
  return text + (shape.size() == 1 ? ",)" : ")");
}

inline Shape shape_of(nb::handle array) {
  Shape shape;
  for (nb::handle extent : array.attr("shape")) shape.push_back(nb::cast<std::int64_t>(extent));
  return shape;
}

inline bool matches(const Shape& found, const Shape& expected) {
  if (found.size() != expected.size()) return false;
  for (std::size_t n = 0; n < found.size(); ++n)
    if (expected[n] != any_size && expected[n] != found[n]) return false;
  return true;
}

/// numpy.asarray(value), or a TypeError that names the argument unless it holds real numbers.
inline nb::object real_array(nb::handle value, const std::string& name) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  nb::object array;
  try {
    array = numpy.attr("asarray")(value);
  } catch (nb::python_error& error) {
    const std::string message = name + ": expected an array of numbers, found " +
                                nb::cast<std::string>(nb::str(value.type().attr("__name__"))) + " (" +
                                nb::cast<std::string>(nb::str(error.value())) + ")";
    throw nb::type_error(message.c_str());
  }
  const auto kind = nb::cast<std::string>(array.attr("dtype").attr("kind"));
  const bool is_empty = nb::cast<std::int64_t>(array.attr("size")) == 0;
  if (kind.find_first_of("biuf") == std::string::npos && !is_empty) {
    const std::string found =
        value.is_none() ? "None" : nb::cast<std::string>(array.attr("dtype").attr("name"));
    throw nb::type_error((name + ": expected real numbers, found " + found).c_str());
  }
  return array;
}

/// "name[1, 2]" for the entry at this place in memory.
inline std::string entry_text(const std::string& name, std::size_t place, const Shape& shape, Order order) {
  std::vector<std::string> indices(shape.size());
  for (std::size_t n = 0; n < shape.size(); ++n) {
    const std::size_t axis = order == Order::C ? shape.size() - 1 - n : n;
    const auto extent = static_cast<std::size_t>(shape[axis]);
    indices[axis] = std::to_string(place % extent);
    place /= extent;
  }
  std::string text = name + "[";
  for (std::size_t n = 0; n < indices.size(); ++n) text += (n ? ", " : "") + indices[n];
  return text + "]";
}

/// Contiguous array of T; integers must survive the conversion.
template <class T>
nb::object converted(const nb::object& real, const std::string& name, Order order) {
  const nb::module_ numpy = nb::module_::import_("numpy");
  if constexpr (std::is_integral_v<T>) {
    const nb::object limits = numpy.attr("iinfo")(Dtype<T>::name);
    const nb::object fits = numpy.attr("logical_and")(numpy.attr("greater_equal")(real, limits.attr("min")),
                                                      numpy.attr("less_equal")(real, limits.attr("max")));
    const nb::object whole = numpy.attr("equal")(numpy.attr("floor")(real), real);
    require(nb::cast<bool>(numpy.attr("all")(numpy.attr("logical_and")(fits, whole)).attr("item")()), name,
            std::string("integers that fit ") + Dtype<T>::name,
            nb::cast<std::string>(real.attr("dtype").attr("name")) + " values that do not");
  }
  const char* layout = order == Order::C ? "C" : "F";
  return numpy.attr("require")(real, Dtype<T>::name, nb::make_tuple(layout, "A"));
}

}  // namespace detail

/// A contiguous array that a caller passed, or a converted copy of it; valid while this object lives.
template <class T>
class Input {
 public:
  Input(nb::handle value, const std::string& name, const Shape& expected, Order order = Order::C)
      : Input(value, name, order) {
    require(detail::matches(shape_, expected), name, "an array of shape " + detail::shape_text(expected),
            detail::shape_text(shape_));
  }
  /// Any shape, in C order.
  Input(nb::handle value, const std::string& name) : Input(value, name, Order::C) {}

  /// Throws at the first entry that is infinite or not a number.
  void require_finite() const {
    for (std::size_t n = 0; n < values_.size(); ++n)
      if (!std::isfinite(values_[n]))
        peclet::require_finite(values_[n], detail::entry_text(name_, n, shape_, order_));
  }

  const T* data() const { return values_.data(); }
  std::size_t size() const { return values_.size(); }
  std::int64_t extent(std::size_t axis) const { return shape_[axis]; }
  const Shape& shape() const { return shape_; }
  std::span<const T> values() const { return values_; }
  T operator[](Index n) const { return values_[static_cast<std::size_t>(n)]; }

 private:
  Input(nb::handle value, const std::string& name, Order order) : name_(name), order_(order) {
    const nb::object real = detail::real_array(value, name);
    shape_ = detail::shape_of(real);
    array_ = nb::cast<Array>(detail::converted<T>(real, name, order));
    values_ = {array_.data(), array_.size()};
  }

  using Array = nb::ndarray<const T, nb::device::cpu>;
  std::string name_;
  Order order_;
  Shape shape_;
  Array array_;
  std::span<const T> values_;
};

/// Parameters that accept every object, to be converted by Input; the names appear in signatures and stubs.
class Numbers : public nb::object {
  NB_OBJECT_DEFAULT(Numbers, nb::object, "collections.abc.Sequence[float]", detail::accept)
};
class Integers : public nb::object {
  NB_OBJECT_DEFAULT(Integers, nb::object, "collections.abc.Sequence[int]", detail::accept)
};
class ArrayLike : public nb::object {
  NB_OBJECT_DEFAULT(ArrayLike, nb::object, "numpy.typing.ArrayLike", detail::accept)
};

/// A NumPy array as a result.
template <class T>
class NumpyArray : public nb::object {
 public:
  static constexpr auto Name = nb::detail::const_name("numpy.typing.NDArray[numpy.") +
                               nb::detail::const_name(detail::Dtype<T>::name) + nb::detail::const_name("]");
  explicit NumpyArray(nb::object array) : nb::object(std::move(array)) {}
  static bool check_(nb::handle) { return true; }
};

/// Memory that becomes a NumPy array of its own; not initialised.
template <class T>
class Output {
 public:
  explicit Output(Shape shape, Order order = Order::C) : shape_(std::move(shape)), order_(order) {
    for (const std::int64_t extent : shape_) size_ *= static_cast<std::size_t>(extent);
    values_ = std::make_unique_for_overwrite<T[]>(size_);
  }

  T* data() { return values_.get(); }
  std::size_t size() const { return size_; }
  T& operator[](Index n) { return values_[static_cast<std::size_t>(n)]; }
  std::span<T> values() { return {values_.get(), size_}; }

  NumpyArray<T> release() {
    const std::size_t axes = shape_.size();
    std::vector<std::size_t> shape(axes);
    std::vector<std::int64_t> strides(axes);
    std::int64_t stride = 1;
    for (std::size_t n = 0; n < axes; ++n) {
      const std::size_t axis = order_ == Order::C ? axes - 1 - n : n;
      shape[axis] = static_cast<std::size_t>(shape_[axis]);
      strides[axis] = stride;
      stride *= shape_[axis];
    }
    T* values = values_.release();
    const nb::capsule owner(values, [](void* memory) noexcept { delete[] static_cast<T*>(memory); });
    return NumpyArray<T>(
        nb::cast(nb::ndarray<nb::numpy, T>(values, axes, shape.data(), owner, strides.data()),
                 nb::rv_policy::reference));
  }

 private:
  Shape shape_;
  Order order_;
  std::size_t size_ = 1;
  std::unique_ptr<T[]> values_;
};

/// Array of this shape, or flat if none is given.
template <class T>
NumpyArray<T> to_numpy(std::span<const T> values, Shape shape = {}, Order order = Order::C) {
  if (shape.empty()) shape = {static_cast<std::int64_t>(values.size())};
  Output<T> output(std::move(shape), order);
  std::copy(values.begin(), values.end(), output.data());
  return output.release();
}

template <class T>
NumpyArray<T> to_numpy(const std::vector<T>& values, Shape shape = {}, Order order = Order::C) {
  return to_numpy(std::span<const T>(values), std::move(shape), order);
}

inline NumpyArray<double> to_numpy(Vec3 v) { return to_numpy(std::vector<double>{v.x, v.y, v.z}); }

/// Memory that lives as long as owner, without a copy: a NumPy array on the host; on a device an object that
/// from_dlpack() of CuPy, PyTorch and JAX takes.
inline nb::object shared_memory(double* first, const std::vector<std::size_t>& shape,
                                const nb::capsule& owner, const std::vector<std::int64_t>& strides = {}) {
  const std::int64_t* const steps = strides.empty() ? nullptr : strides.data();
  if constexpr (is_host_memory)
    return nb::cast(nb::ndarray<nb::numpy, double>(first, shape.size(), shape.data(), owner, steps),
                    nb::rv_policy::reference);
  else
    return nb::cast(nb::ndarray<nb::array_api, double>(first, shape.size(), shape.data(), owner, steps,
                                                       nb::dtype<double>(), nb::device::cuda::value),
                    nb::rv_policy::reference);
}

/// The numbers of an array as one row of columns per element: writing to either changes both.
template <class T>
nb::object view_of(const Array<T>& array, Index rows) {
  constexpr std::size_t columns = sizeof(T) / sizeof(double);
  const nb::capsule owner(new Array<T>(array),
                          [](void* view) noexcept { delete static_cast<Array<T>*>(view); });
  std::vector<std::size_t> shape{static_cast<std::size_t>(rows)};
  if constexpr (columns > 1) shape.push_back(columns);
  return shared_memory(reinterpret_cast<double*>(array.data()), shape, owner);
}

/// The cells of a field, shape (nx, ny, nz) and x fastest, rows apart by ghosts and padding: writing to
/// either changes both.
inline nb::object view_of(const Field<double>& field) {
  const nb::capsule owner(new Field<double>(field),
                          [](void* view) noexcept { delete static_cast<Field<double>*>(view); });
  const Layout& layout = field.layout();
  std::vector<std::size_t> shape;
  for (int a = 0; a < 3; ++a) shape.push_back(static_cast<std::size_t>(layout.cells[a]));
  return shared_memory(field.data() + layout(0, 0, 0), shape, owner, {1, layout.pitch_y, layout.pitch_z});
}

/// Its first rows elements, copied.
template <class T>
nb::object to_numpy(const Array<T>& array, Index rows) {
  constexpr std::int64_t columns = sizeof(T) / sizeof(double);
  Output<double> output(columns == 1 ? Shape{rows} : Shape{rows, columns});
  const Kokkos::View<T*, Kokkos::HostSpace, Kokkos::MemoryUnmanaged> host(reinterpret_cast<T*>(output.data()),
                                                                          static_cast<std::size_t>(rows));
  Kokkos::deep_copy(host, Kokkos::subview(array, std::make_pair(Index{0}, rows)));
  return output.release();
}

/// Cells of a field without its ghosts: shape (nx, ny, nz), Fortran order.
template <class T>
NumpyArray<T> to_numpy(const Field<T>& field) {
  const Int3 n = field.layout().cells;
  Output<T> output({n[0], n[1], n[2]}, Order::Fortran);
  copy_to_host(field, output.data());
  return output.release();
}

/// Fill the cells of a field from an array of shape (nx, ny, nz) with finite entries.
template <class T>
void assign(const Field<T>& field, nb::handle value, const std::string& name) {
  const Int3 n = field.layout().cells;
  const Input<T> input(value, name, {n[0], n[1], n[2]}, Order::Fortran);
  input.require_finite();
  copy_from_host(input.data(), field);
}

/// Any sequence of count finite numbers.
template <std::size_t count>
std::array<double, count> to_numbers(nb::handle value, const std::string& name) {
  const Input<double> input(value, name, {static_cast<std::int64_t>(count)});
  input.require_finite();
  std::array<double, count> numbers;
  std::copy(input.values().begin(), input.values().end(), numbers.begin());
  return numbers;
}

inline Vec3 to_vec3(nb::handle value, const std::string& name) {
  const auto [x, y, z] = to_numbers<3>(value, name);
  return {x, y, z};
}

inline Quaternion to_quaternion(nb::handle value, const std::string& name) {
  const auto [x, y, z, w] = to_numbers<4>(value, name);
  return {x, y, z, w};
}

}  // namespace peclet::python
