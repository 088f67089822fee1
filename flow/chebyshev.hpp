#pragma once
// Chebyshev iteration e += w_m D^-1 (r - A e): the weights are the inverse roots of a Chebyshev polynomial
// on an interval of the eigenvalues of D^-1 A [Saad2003, section 12.3].
#include <cmath>
#include <numbers>

#include "core/types.hpp"

namespace peclet::flow {

/// Interval of eigenvalues.
struct Spectrum {
  Real middle = 1, half_width = 0;

  Real high() const { return middle + half_width; }
};

/// Weight of sweep m of n, in an order that keeps intermediate iterates small (pairs from both ends).
inline float chebyshev_weight(int m, int n, const Spectrum& spectrum) {
  const int root = m % 2 == 0 ? m / 2 : n - 1 - m / 2;
  const Real cosine = std::cos(std::numbers::pi * (2 * root + 1) / (2.0 * n));
  return static_cast<float>(1 / (spectrum.middle - spectrum.half_width * cosine));
}

}  // namespace peclet::flow
