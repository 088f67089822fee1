#include "dem/neighbor_search.hpp"

#include <gtest/gtest.h>

#include "particles_in_tests.hpp"

namespace peclet::dem {
namespace {

/// Contacts by looking at every pair and every image.
Index count_by_brute_force(const std::vector<Vec3>& x, const std::vector<Real>& radius,
                           const Domain& domain) {
  Index count = 0;
  const int turns[] = {domain.wraps(0), domain.wraps(1), domain.wraps(2)};
  for (std::size_t a = 0; a < x.size(); ++a)
    for (std::size_t b = 0; b < a; ++b)
      for (int i = -turns[0]; i <= turns[0]; ++i)
        for (int j = -turns[1]; j <= turns[1]; ++j)
          for (int k = -turns[2]; k <= turns[2]; ++k) {
            const Vec3 shift{i * domain.extent.x, j * domain.extent.y, k * domain.extent.z};
            const Real reach = (1 + 0.5 * contact_margin) * (radius[a] + radius[b]);
            count += norm(x[a] - x[b] - shift) < reach;
          }
  return count;
}

Index count_by_search(const std::vector<Vec3>& x, const std::vector<Real>& radius, const Domain& domain) {
  Simulation simulation = testing::spheres(x, 1);
  simulation.particles().set_scales(radius);
  simulation.set_domain(domain.origin, domain.extent);
  simulation.set_periodic(domain.periodic[0], domain.periodic[1], domain.periodic[2]);
  return simulation.census().number_of_contacts;
}

struct SearchCase {
  const char* name;
  Real smallest, largest;
  Vec3 extent;
  bool is_periodic;
};

class Search : public ::testing::TestWithParam<SearchCase> {};

TEST_P(Search, FindsThePairsThatBruteForceFinds) {
  const SearchCase& parameters = GetParam();
  const Vec3 low{-3, 2, 100};
  const auto x = testing::random_vectors(400, low, low + parameters.extent, 1);
  const auto sizes = testing::random_vectors(400, {0, 0, 0}, {1, 1, 1}, 2);
  std::vector<Real> radius;
  for (const Vec3& size : sizes)
    radius.push_back(parameters.smallest * std::pow(parameters.largest / parameters.smallest, size.x));
  const bool p = parameters.is_periodic;
  const Domain domain{low, parameters.extent, {p, false, p}};
  EXPECT_EQ(count_by_search(x, radius, domain), count_by_brute_force(x, radius, domain));
}

INSTANTIATE_TEST_SUITE_P(NeighborSearch, Search,
                         ::testing::Values(SearchCase{"Equal", 0.5, 0.5, {9, 11, 13}, false},
                                           SearchCase{"Periodic", 0.5, 0.5, {9, 11, 13}, true},
                                           SearchCase{"Unequal", 0.05, 2, {9, 11, 13}, true},
                                           SearchCase{"FewDiametersWide", 0.4, 0.5, {2.5, 30, 1.1}, true},
                                           SearchCase{"Scattered", 0.5, 0.5, {1e6, 1, 1e6}, true}),
                         [](const ::testing::TestParamInfo<SearchCase>& info) { return info.param.name; });

TEST(NeighborSearch, TakesParticlesFarAway) {
  const std::vector<Vec3> x{{0, 0, 0}, {1e300, -1e300, 1e17}, {1.5, 0, 0}};
  EXPECT_EQ(count_by_search(x, {1, 1, 1}, {}), 1);
}

}  // namespace
}  // namespace peclet::dem
