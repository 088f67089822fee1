#include "core/sampled_shape.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>
#include <vector>

#include "core/field_transfer.hpp"

namespace {

using namespace peclet;

const Lattice lattice{{5, 4, 3}, {-1, 0.5, 2}, {0.5, 1, 2}};  // to (1, 3.5, 6)

/// 1 + 2 x - 3 y + 0.5 z on the lattice
std::vector<float> linear_values() {
  std::vector<float> values;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 5; ++i)
        values.push_back(static_cast<float>(1 + 2 * (-1 + 0.5 * i) - 3 * (0.5 + j) + 0.5 * (2 + 2 * k)));
  return values;
}

std::vector<sdf::Dual> evaluate(const SampledShape& shape, const std::vector<Vec3>& points) {
  const Array<Vec3> x = copy_from_host("x", points);
  const Array<sdf::Dual> d("d", points.size());
  for_each(
      "evaluate", static_cast<Index>(points.size()),
      KOKKOS_LAMBDA(Index n) { d(n) = shape.distance_and_gradient(x(n)); });
  return copy_to_host(d);
}

TEST(SampledShape, IsExactForLinearFunctionsInsideTheLattice) {
  const SampledShape shape(lattice, linear_values());
  const std::vector<Vec3> points{{-0.3, 1.2, 3.3}, {0.9, 3.4, 5.9}, {-1, 0.5, 2}, {0, 2.5, 4}};
  const auto found = evaluate(shape, points);
  for (std::size_t n = 0; n < points.size(); ++n) {
    const Vec3 p = points[n];
    EXPECT_NEAR(found[n].value, 1 + 2 * p.x - 3 * p.y + 0.5 * p.z, 1e-12);
    EXPECT_NEAR(norm(found[n].gradient - Vec3{2, -3, 0.5}), 0, 1e-12);
  }
}

TEST(SampledShape, GrowsByTheDistanceToTheLatticeOutsideIt) {
  const SampledShape shape(lattice, linear_values());
  const auto found = evaluate(shape, {{-1, 1, 3}, {-4, 1, 3}, {1, 3.5, 6}, {4, 7.5, 6}});
  EXPECT_NEAR(found[1].value, found[0].value + 3, 1e-12);
  EXPECT_NEAR(found[1].gradient.x, -1, 1e-12);
  EXPECT_NEAR(found[3].value, found[2].value + 5, 1e-12);
}

TEST(SampledShape, RefusesWhatIsNoLattice) {
  std::vector<float> values = linear_values();
  EXPECT_THROW(SampledShape({{5, 4, 1}, {}, {1, 1, 1}}, std::vector<float>(20)), std::invalid_argument);
  EXPECT_THROW(SampledShape({{5, 4, 3}, {}, {1, 0, 1}}, values), std::invalid_argument);
  EXPECT_THROW(SampledShape({{5, 4, 4}, {}, {1, 1, 1}}, values), std::invalid_argument);
  values[7] = std::nanf("");
  EXPECT_THROW(SampledShape(lattice, values), std::invalid_argument);
}

}  // namespace
