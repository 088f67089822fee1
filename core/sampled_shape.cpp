#include "core/sampled_shape.hpp"

#include <cmath>

#include "core/error.hpp"
#include "core/field_transfer.hpp"

namespace peclet {

SampledShape::SampledShape(const Lattice& lattice, std::span<const float> values) : lattice_(lattice) {
  for (int axis = 0; axis < 3; ++axis) {
    require(lattice.points[axis] >= 2, indexed("grid extent", axis), "at least 2 points",
            lattice.points[axis]);
    require_finite(lattice.origin[axis], indexed("origin", axis));
    require_positive(lattice.spacing[axis], indexed("spacing", axis));
  }
  require(static_cast<Index>(values.size()) == lattice.size(), "grid",
          std::to_string(lattice.size()) + " values", values.size());
  for (std::size_t n = 0; n < values.size(); ++n)
    require_finite(values[n], "grid value " + std::to_string(n));
  values_ = copy_from_host("core::SampledShape", values.data(), lattice.size());
}

}  // namespace peclet
