#include "core/loop.hpp"

#include <gtest/gtest.h>

#include "core/field_transfer.hpp"

namespace {

using namespace peclet;

/// Every second row starts one cell late, every third ends two cells early.
RowRanges ragged_rows(const Box& box) {
  RowRanges ranges(box);
  std::vector<int> first, last;
  for (Index row = 0; row < ranges.number_of_rows(); ++row) {
    first.push_back(box.low[0] + (row % 2 == 0));
    last.push_back(box.high[0] - 2 * (row % 3 == 0));
  }
  ranges.first = copy_from_host("first", first);
  ranges.last = copy_from_host("last", last);
  return ranges;
}

std::vector<int> visits(const Int3& cells, const RowRanges& ranges) {
  const Field<int> count("count", Layout(cells));
  for_each_cell("count_visits", ranges, KOKKOS_LAMBDA(int i, int j, int k) { count(i, j, k) += 1; });
  std::vector<int> host(static_cast<std::size_t>(cells[0] * cells[1] * cells[2]));
  copy_to_host(count, host.data());
  return host;
}

Real sum_of_indices(const RowRanges& ranges) {
  return sum_cells(
      "sum_of_indices", ranges, KOKKOS_LAMBDA(int i, int j, int k) { return i + 10.0 * j + 100.0 * k; });
}

Real largest_index(const RowRanges& ranges, Real offset) {
  return max_cells(
      "largest_index", ranges,
      KOKKOS_LAMBDA(int i, int j, int k) { return offset + i + 10.0 * j + 100.0 * k; });
}

const Int3 cells{7, 5, 4};
const Box inner{{1, 0, 2}, {6, 4, 4}};

TEST(Loop, VisitsTheCellsOfABoxOnce) {
  const std::vector<int> count = visits(cells, RowRanges(inner));
  for (int k = 0; k < cells[2]; ++k)
    for (int j = 0; j < cells[1]; ++j)
      for (int i = 0; i < cells[0]; ++i)
        EXPECT_EQ(count[static_cast<std::size_t>(i + cells[0] * (j + cells[1] * k))],
                  inner.contains(i, j, k));
}

TEST(Loop, RespectsTheRangeOfEveryRow) {
  const RowRanges ranges = ragged_rows(inner);
  const std::vector<int> count = visits(cells, ranges);
  int total = 0;
  for (const int n : count) {
    EXPECT_LE(n, 1);
    total += n;
  }
  // 8 rows of 5 cells; 4 start late, rows 0, 3, 6 end two cells early
  EXPECT_EQ(total, 8 * 5 - 4 - 3 * 2);
}

TEST(Loop, AnEmptyBoxIsLeftOut) {
  const RowRanges nothing(Box{{3, 1, 1}, {3, 4, 4}});
  EXPECT_EQ(sum_of_indices(nothing), 0);
  EXPECT_EQ(largest_index(nothing, 5), 0);
}

TEST(Loop, SumsOverABox) {
  // mean index along each axis times the number of cells
  EXPECT_EQ(sum_of_indices(RowRanges(inner)), 40 * (3.0 + 10 * 1.5 + 100 * 2.5));
}

TEST(Loop, SumsAndMaximaRespectTheRangeOfEveryRow) {
  Real expected = 0;
  const RowRanges ranges = ragged_rows(inner);
  for (Index row = 0; row < ranges.number_of_rows(); ++row) {
    const int j = static_cast<int>(row % 4), k = 2 + static_cast<int>(row / 4);
    for (int i = 1 + (row % 2 == 0); i < 6 - 2 * (row % 3 == 0); ++i) expected += i + 10.0 * j + 100.0 * k;
  }
  EXPECT_EQ(sum_of_indices(ranges), expected);
  EXPECT_EQ(largest_index(ranges, 0), 335);  // row 7 ends where the box does
}

TEST(Loop, TheLargestOfNegativeNumbersIsZero) { EXPECT_EQ(largest_index(RowRanges(inner), -1000), 0); }

Index list_multiples(Index count, Index step, const Array<Index>& list) {
  return list_where("list_multiples", count, list, KOKKOS_LAMBDA(Index n) { return n % step == 0; });
}

TEST(ListWhere, ListsWhatIsKeptInOrder) {
  for (const std::size_t count : {20, 2000}) {  // by one thread, by several
    const Array<Index> list("list", count);
    const Index number = list_multiples(static_cast<Index>(count), 3, list);
    ASSERT_EQ(number, static_cast<Index>((count + 2) / 3));
    const std::vector<Index> host = copy_to_host(list);
    for (Index n = 0; n < number; ++n) EXPECT_EQ(host[static_cast<std::size_t>(n)], 3 * n);
  }
}

TEST(ListWhere, OfNothingIsNothing) { EXPECT_EQ(list_multiples(0, 3, Array<Index>()), 0); }

Index triangular_numbers(Index count, const Array<Index>& offsets) {
  return exclusive_sum("triangular_numbers", count, offsets, KOKKOS_LAMBDA(Index n) { return n + 1; });
}

TEST(ExclusiveSum, AddsWhatComesBefore) {
  const Array<Index> offsets("offsets", 6);
  EXPECT_EQ(triangular_numbers(5, offsets), 15);
  EXPECT_EQ(copy_to_host(offsets), (std::vector<Index>{0, 1, 3, 6, 10, 15}));
  const Array<Index> many("offsets", 1001);
  EXPECT_EQ(triangular_numbers(1000, many), 500500);
  EXPECT_EQ(copy_to_host(many)[600], 600 * 601 / 2);
}

Real sum_of_numbers(Index count) {
  return sum_each("sum_of_numbers", count, KOKKOS_LAMBDA(Index n) { return static_cast<Real>(n); });
}
Real largest_number(Index count) {
  return max_each("largest_number", count, KOKKOS_LAMBDA(Index n) { return static_cast<Real>(n) - 3; });
}

TEST(Lists, AreReducedByOneThreadOrSeveral) {
  for (const Index count : {0, 2, 20, 2000}) {
    EXPECT_EQ(sum_of_numbers(count), static_cast<Real>(count * (count - 1) / 2));
    EXPECT_EQ(largest_number(count), count < 4 ? 0 : static_cast<Real>(count - 4));
  }
}

}  // namespace
