#include "core/halo.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace {

using namespace peclet;

/// Fills cells with numbers of their own, then the ghosts; ghosts start from -1.
std::vector<int> filled(const Layout& layout, const Periodicity& periodic) {
  const Field<int> field("field", layout);
  field.fill(-1);
  const Int3 n = layout.cells;
  for_each_cell(
      "number_cells", RowRanges(n),
      KOKKOS_LAMBDA(int i, int j, int k) { field(i, j, k) = i + n[0] * (j + n[1] * k); });
  fill_periodic_ghosts(field, periodic);
  std::vector<int> host(static_cast<std::size_t>(layout.size));
  const Kokkos::View<int*, Kokkos::HostSpace> view(host.data(), host.size());
  Kokkos::deep_copy(view, field.array());
  return host;
}

int wrap(int i, int n) { return ((i % n) + n) % n; }

void expect_periodic(const Int3& n, const Periodicity& periodic) {
  const Layout layout(n);
  const std::vector<int> values = filled(layout, periodic);
  constexpr int g = Layout::ghost_width;
  for (int k = -g; k < n[2] + g; ++k)
    for (int j = -g; j < n[1] + g; ++j)
      for (int i = -g; i < n[0] + g; ++i) {
        const int p[3] = {i, j, k};
        bool reachable = true;
        for (int a = 0; a < 3; ++a) reachable = reachable && (periodic.axis[a] || (p[a] >= 0 && p[a] < n[a]));
        const int expected = reachable ? wrap(i, n[0]) + n[0] * (wrap(j, n[1]) + n[1] * wrap(k, n[2])) : -1;
        EXPECT_EQ(values[static_cast<std::size_t>(layout(i, j, k))], expected) << i << ' ' << j << ' ' << k;
      }
}

TEST(PeriodicGhosts, RepeatTheFarSideWithEdgesAndCorners) { expect_periodic({5, 3, 4}, {}); }

TEST(PeriodicGhosts, RepeatShortAxesAsOftenAsNeeded) { expect_periodic({1, 2, 3}, {}); }

TEST(PeriodicGhosts, OtherAxesStayAsTheyAre) { expect_periodic({5, 3, 4}, {{true, false, true}}); }

}  // namespace
