#include "flow/fluid_regions.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <queue>

#include "tests/unit/flow/pressure_cases.hpp"

namespace peclet::flow {
namespace {

using namespace testing;

struct Flood {
  std::vector<int> region;  ///< -1 in closed cells
  int number = 0;
};

/// Regions by flooding from cell to cell.
Flood flood(const FaceVector<OpenFraction>& open, const PressureSides& sides) {
  const Int3 n = open.x.layout().cells;
  const auto index = [&](const Int3& c) { return c[0] + n[0] * (c[1] + n[1] * c[2]); };
  Flood result;
  result.region.assign(static_cast<std::size_t>(n[0]) * n[1] * n[2], -1);
  for_cells(n, [&](int i, int j, int k) {
    if (!is_open_cell(open, i, j, k) || result.region[index({i, j, k})] >= 0) return;
    std::queue<Int3> front;
    front.push({i, j, k});
    result.region[index({i, j, k})] = result.number;
    while (!front.empty()) {
      const Int3 cell = front.front();
      front.pop();
      for (int axis = 0; axis < 3; ++axis)
        for (int high = 0; high < 2; ++high) {
          Int3 face = cell, other = cell;
          face[axis] += high;
          other[axis] += high ? 1 : -1;
          if (!open[axis](face[0], face[1], face[2])) continue;
          if (other[axis] < 0 || other[axis] >= n[axis]) {
            if (!sides.is_periodic(axis)) continue;
            other[axis] = wrapped(other[axis], n[axis]);
          }
          int& found = result.region[index(other)];
          if (found >= 0) continue;
          found = result.number;
          front.push(other);
        }
    }
    ++result.number;
  });
  return result;
}

Faces random_faces(const Int3& n, int percent_open, unsigned seed) {
  return [=](int axis, int i, int j, int k) -> OpenFraction {
    std::mt19937 generator(seed + static_cast<unsigned>(((k * n[1] + j) * n[0] + i) * 3 + axis + 1));
    generator.discard(3);
    return static_cast<int>(generator() % 100) < percent_open ? OpenFraction{1} : OpenFraction{0};
  };
}

TEST(FluidRegions, AreThoseOfAFlood) {
  for (const Int3& n : {Int3{70, 9, 8}, Int3{64, 7, 5}, Int3{130, 3, 4}, Int3{12, 20, 18}, Int3{3, 2, 9}})
    for (const int percent_open : {5, 20, 26, 40, 100})
      for (const PressureSide side : {PressureSide::Periodic, PressureSide::Closed}) {
        PressureSides sides;
        for (auto& axis : sides.side) axis[0] = axis[1] = side;
        const auto open = make_faces(n, sides, random_faces(n, percent_open, 7));
        const LevelShape shape(n, sides);
        FluidRegions regions(shape);
        regions.find(LevelOperator<OpenFraction>(shape, open, {1, 1, 1}));
        const Flood expected = flood(open, sides);
        EXPECT_EQ(regions.number_of_regions(), expected.number);
        EXPECT_EQ(
            regions.number_of_open_cells(),
            std::count_if(expected.region.begin(), expected.region.end(), [](int r) { return r >= 0; }));
      }
}

TEST(FluidRegions, LargeOnesFormGroupsOfTheirOwn) {
  const Int3 n{70, 20, 22};
  // Slabs of 33, 1, 20 and 16 planes across x.
  const auto slabs = [](int axis, int i, int, int) {
    return axis == 0 && (i == 0 || i == 33 || i == 34 || i == 54) ? OpenFraction{0} : fully_open;
  };
  const auto open = make_faces(n, PressureSides(), slabs);
  const LevelShape shape(n, PressureSides());
  FluidRegions regions(shape);
  regions.find(LevelOperator<OpenFraction>(shape, open, {1, 1, 1}));
  EXPECT_EQ(regions.number_of_regions(), 4);
  ASSERT_EQ(regions.number_of_groups(), 3);
  const Field<unsigned char> group("group", shape.layout);
  const std::vector<Box> boxes = regions.write_groups(group);
  ASSERT_EQ(boxes.size(), 3U);
  const int low[] = {0, 34, 54}, high[] = {34, 54, 70};
  for (int g = 0; g < 3; ++g) {
    EXPECT_EQ(boxes[g].low[0], low[g]);
    EXPECT_EQ(boxes[g].high[0], high[g]);
    EXPECT_EQ(boxes[g].extent(1), n[1]);
    EXPECT_EQ(boxes[g].extent(2), n[2]);
  }
  for_cells(n, [&](int i, int j, int k) { EXPECT_EQ(group(i, j, k), (i >= 34) + (i >= 54)); });
}

TEST(FluidRegions, MeansVanishWhereNoFixedSideTouches) {
  const Int3 n{66, 11, 9};
  const PressureSides sides =
      sides_of(PressureSide::Fixed, PressureSide::Closed, PressureSide::Periodic, PressureSide::Closed);
  const auto open = make_faces(n, sides, random_faces(n, 22, 3));
  const LevelShape shape(n, sides);
  FluidRegions regions(shape);
  regions.find(LevelOperator<OpenFraction>(shape, open, {1, 1, 1}));
  const Field<Real> rhs = random_field(n, 51, 2), original = random_field(n, 51, 2);
  regions.remove_means(rhs);
  const Flood expected = flood(open, sides);
  std::vector<Real> sum(static_cast<std::size_t>(expected.number));
  std::vector<bool> is_fixed(static_cast<std::size_t>(expected.number)), changed = is_fixed;
  for_cells(n, [&](int i, int j, int k) {
    const int region = expected.region[static_cast<std::size_t>(i + n[0] * (j + n[1] * k))];
    if (region < 0) {
      EXPECT_EQ(rhs(i, j, k), original(i, j, k));
      return;
    }
    sum[region] += rhs(i, j, k);
    if (i == 0 && open.x(0, j, k)) is_fixed[region] = true;
    if (rhs(i, j, k) != original(i, j, k)) changed[region] = true;
  });
  for (int r = 0; r < expected.number; ++r) {
    if (is_fixed[r]) {
      EXPECT_FALSE(changed[r]);
    } else {
      EXPECT_NEAR(sum[r], 0, 1e-11);
    }
  }
}

TEST(FluidRegions, UpdateEqualsANewSearch) {
  const Int3 n{70, 20, 16};
  const PressureSides sides;
  const auto open = make_faces(n, sides, random_faces(n, 30, 1));
  const LevelShape shape(n, sides);
  const LevelOperator<OpenFraction> op(shape, open, {1, 1, 1});
  FluidRegions regions(shape);
  regions.find(op);
  const Box box{{-5, 3, 12}, {4, 12, 19}};
  const auto before = random_faces(n, 30, 1), after = random_faces(n, 18, 2);
  fill_faces(open, sides, [&](int axis, int i, int j, int k) {
    const bool inside = (i >= 65 || i < 4) && j >= 3 && j < 12 && (k >= 12 || k < 3);
    return inside ? after(axis, i, j, k) : before(axis, i, j, k);
  });
  regions.update(op, {box});
  const Flood expected = flood(open, sides);
  EXPECT_EQ(regions.number_of_regions(), expected.number);
}

}  // namespace
}  // namespace peclet::flow
