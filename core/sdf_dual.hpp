#pragma once
// A number together with its gradient, so that each distance is written once and differentiated exactly.
// Where a distance has no derivative (the centre of a sphere) its gradient is a one-sided one.
#include "core/types.hpp"
#include "core/vec3.hpp"

namespace peclet::sdf {

struct Dual {
  Real value = 0;
  Vec3 gradient;

  Dual() = default;
  KOKKOS_INLINE_FUNCTION Dual(Real v) : value(v) {}
  KOKKOS_INLINE_FUNCTION Dual(Real v, Vec3 g) : value(v), gradient(g) {}
};

KOKKOS_INLINE_FUNCTION Dual operator+(Dual a, Dual b) { return {a.value + b.value, a.gradient + b.gradient}; }
KOKKOS_INLINE_FUNCTION Dual operator-(Dual a, Dual b) { return {a.value - b.value, a.gradient - b.gradient}; }
KOKKOS_INLINE_FUNCTION Dual operator-(Dual a) { return {-a.value, -a.gradient}; }
KOKKOS_INLINE_FUNCTION Dual operator*(Dual a, Dual b) {
  return {a.value * b.value, b.value * a.gradient + a.value * b.gradient};
}
KOKKOS_INLINE_FUNCTION Dual operator/(Dual a, Dual b) {
  const Real quotient = a.value / b.value;
  return {quotient, (a.gradient - quotient * b.gradient) / b.value};
}

KOKKOS_INLINE_FUNCTION Real value_of(Real a) { return a; }
KOKKOS_INLINE_FUNCTION Real value_of(Dual a) { return a.value; }

KOKKOS_INLINE_FUNCTION Real square_root(Real a) { return Kokkos::sqrt(a); }
KOKKOS_INLINE_FUNCTION Dual square_root(Dual a) {
  const Real root = Kokkos::sqrt(a.value);
  return root > 0 ? Dual{root, a.gradient / (2 * root)} : Dual{root};
}

/// base^exponent for base >= 0
KOKKOS_INLINE_FUNCTION Real power(Real base, Real exponent) { return Kokkos::pow(base, exponent); }
KOKKOS_INLINE_FUNCTION Dual power(Dual base, Real exponent) {
  const Real value = Kokkos::pow(base.value, exponent);
  return base.value > 0 ? Dual{value, (exponent * value / base.value) * base.gradient} : Dual{value};
}

template <class T>
KOKKOS_INLINE_FUNCTION T absolute(T a) {
  return value_of(a) < 0 ? -a : a;
}
/// On a tie the first argument is kept.
template <class T>
KOKKOS_INLINE_FUNCTION T larger(T a, T b) {
  return value_of(b) > value_of(a) ? b : a;
}
template <class T>
KOKKOS_INLINE_FUNCTION T smaller(T a, T b) {
  return value_of(b) < value_of(a) ? b : a;
}
/// Length of the vector whose square and first component are given. At zero its derivative is that of the
/// component, one of the many one-sided ones.
KOKKOS_INLINE_FUNCTION Real length_of(Real square, Real) { return Kokkos::sqrt(square); }
KOKKOS_INLINE_FUNCTION Dual length_of(Dual square, Dual component) {
  return square.value > 0 ? square_root(square) : component;
}
template <class T>
KOKKOS_INLINE_FUNCTION T length(T a, T b) {
  return length_of(a * a + b * b, a);
}
template <class T>
KOKKOS_INLINE_FUNCTION T length(T a, T b, T c) {
  return length_of(a * a + b * b + c * c, a);
}

/// The number with this value and these partial derivatives with respect to x, y, z.
KOKKOS_INLINE_FUNCTION Real with_partials(Real value, Vec3, Real, Real, Real) { return value; }
KOKKOS_INLINE_FUNCTION Dual with_partials(Real value, Vec3 partials, Dual x, Dual y, Dual z) {
  return {value, partials.x * x.gradient + partials.y * y.gradient + partials.z * z.gradient};
}

}  // namespace peclet::sdf
