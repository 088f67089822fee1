#include "core/sweep.hpp"

#include <gtest/gtest.h>

#include "core/field.hpp"

namespace peclet {
namespace {

/// out = in of the cell + in of the two planes or rows beside it, wrapped.
struct AddNeighbours {
  using Result = Total;
  static constexpr bool may_overrun = false;
  Layout layout;
  Int3 n;
  const Real* in;
  Real* out;

  struct Row {
    const Real *centre, *south, *north, *below, *above;
    Real* out;
    KOKKOS_INLINE_FUNCTION Real operator()(int i) const {
      out[i] = centre[i] + 2 * south[i] + 3 * north[i] + 5 * below[i] + 7 * above[i];
      return out[i];
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const int js = j > 0 ? j - 1 : n[1] - 1, jn = j < n[1] - 1 ? j + 1 : 0;
    const int kb = k > 0 ? k - 1 : n[2] - 1, ka = k < n[2] - 1 ? k + 1 : 0;
    return {in + layout(0, j, k),  in + layout(0, js, k), in + layout(0, jn, k),
            in + layout(0, j, kb), in + layout(0, j, ka), out + layout(0, j, k)};
  }
};

/// Integers, so that sums are exact in any order.
Field<Real> integers(const Int3& n) {
  const Field<Real> field("integers", Layout(n));
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) field(i, j, k) = (i * 7 + j * 13 + k * 29) % 11;
  return field;
}

Real plain(const Int3& n, const Field<Real>& in, const Field<Real>& out) {
  Real sum = 0;
  const AddNeighbours body{in.layout(), n, in.array().data(), out.array().data()};
  for (int k = 0; k < n[2]; ++k)
    for (int j = 0; j < n[1]; ++j)
      for (int i = 0; i < n[0]; ++i) sum += body.row(j, k)(i);
  return sum;
}

TEST(Sweep, StagesSeeWhatTheStageBeforeWrote) {
  for (const Int3& n : {Int3{5, 4, 1}, Int3{6, 1, 5}, Int3{7, 3, 4}, Int3{40, 30, 29}, Int3{33, 41, 2},
                        Int3{20, 24, 64}, Int3{17, 25, 63}}) {
    const Layout layout(n);
    const Field<Real> in = integers(n), a("a", layout), b("b", layout), c("c", layout), d("d", layout);
    const bool wraps[3] = {true, true, true};
    const SweepPlan plan(n, Box{{0, 0, 0}, n}, wraps);
    const RowRanges rows(n);
    // The third stage overwrites what the second one read.
    const Total total =
        sweep("test", plan, Stage{rows, AddNeighbours{layout, n, in.array().data(), a.array().data()}},
              Stage{rows, AddNeighbours{layout, n, a.array().data(), b.array().data()}},
              Stage{rows, AddNeighbours{layout, n, b.array().data(), a.array().data()}});
    plain(n, in, c);
    plain(n, c, d);
    const Real expected = plain(n, d, c);
    EXPECT_EQ(total.sum, expected);
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) ASSERT_EQ(a(i, j, k), c(i, j, k));
  }
}

/// coarse = sum of the planes 2 K - shift and 2 K - shift + 1, as far as they exist.
struct AddPlanes {
  using Result = Nothing;
  static constexpr bool may_overrun = false;
  Layout fine_layout, coarse_layout;
  int shift;
  const Real* fine;
  Real* coarse;

  struct Row {
    const Real *low, *high;
    Real* coarse;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      coarse[i] = (low ? low[i] : 0) + (high ? high[i] : 0);
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const int low = 2 * k - shift, high = low + 1;
    return {low >= 0 ? fine + fine_layout(0, j, low) : nullptr,
            high < fine_layout.cells[2] ? fine + fine_layout(0, j, high) : nullptr,
            coarse + coarse_layout(0, j, k)};
  }
};

TEST(Sweep, CoarsensPairsOfPlanesThatBeginAtEitherParity) {
  for (const int planes : {9, 33, 64, 95})
    for (const int shift : {0, 1}) {
      const Int3 n{21, 37, planes}, coarse_n{n[0], n[1], (planes + shift + 1) / 2};
      const Layout layout(n), coarse_layout(coarse_n);
      const Field<Real> in = integers(n), a("a", layout), b("b", layout), c("c", layout);
      const Field<Real> found("found", coarse_layout), expected("expected", coarse_layout);
      const bool wraps[3] = {true, true, true};
      const auto coarsen = [&](const Field<Real>& fine, const Field<Real>& coarse) {
        return Stage(RowRanges(coarse_n),
                     AddPlanes{layout, coarse_layout, shift, fine.data(), coarse.data()});
      };
      sweep("test", SweepPlan(n, Box{{0, 0, 0}, n}, wraps, {0, 0, shift}),
            Stage{RowRanges(n), AddNeighbours{layout, n, in.data(), a.data()}},
            Stage{RowRanges(n), AddNeighbours{layout, n, a.data(), b.data()}},
            CoarseningStage{Stage{RowRanges(n), AddNeighbours{layout, n, b.data(), a.data()}},
                            coarsen(a, found),
                            {1, 1, 2},
                            {0, 0, shift}});
      plain(n, in, b);
      plain(n, b, c);
      plain(n, c, a);
      sweep("test", SweepPlan(coarse_n, Box{{0, 0, 0}, coarse_n}, wraps), coarsen(a, expected));
      for (int k = 0; k < coarse_n[2]; ++k)
        for (int j = 0; j < n[1]; ++j)
          for (int i = 0; i < n[0]; ++i) ASSERT_EQ(found(i, j, k), expected(i, j, k)) << planes << " " << k;
    }
}

TEST(Sweep, ASeriesIsItsStagesOneAfterTheOther) {
  for (const Int3& n : {Int3{6, 1, 5}, Int3{7, 3, 4}, Int3{20, 24, 64}, Int3{33, 41, 2}})
    for (const int repetitions : {0, 1, 2, 9}) {
      const Layout layout(n);
      const bool wraps[3] = {true, true, true};
      const SweepPlan plan(n, Box{{0, 0, 0}, n}, wraps);
      const RowRanges rows(n);
      const Field<Real> in = integers(n), a("a", layout), b("b", layout), c("c", layout), d("d", layout);
      const auto stage = [&](const Field<Real>& from, const Field<Real>& to) {
        return Stage(rows, AddNeighbours{layout, n, from.data(), to.data()});
      };
      const Field<Real>&odd = repetitions % 2 ? b : a, &even = repetitions % 2 ? a : b;
      const Total total = sweep_series(
          "test", plan, stage(in, a), repetitions, [&](int m) { return m % 2 ? stage(b, a) : stage(a, b); },
          stage(odd, even));
      Real expected = plain(n, in, c);
      for (int m = 0; m <= repetitions; ++m) expected = m % 2 ? plain(n, d, c) : plain(n, c, d);
      EXPECT_NEAR(total.sum / expected, 1, 1e-12);  // too large to be exact
    }
}

struct Value {
  using Result = Norms;
  static constexpr bool may_overrun = true;
  Layout layout;
  const Real* in;
  struct Row {
    const Real* in;
    KOKKOS_INLINE_FUNCTION Real operator()(int i) const { return in[i]; }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const { return {in + layout(0, j, k)}; }
};

/// Sets a row to 1.
struct SetToOne {
  using Result = Nothing;
  static constexpr bool may_overrun = false;
  Layout layout;
  Real* out;
  struct Row {
    Real* out;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const { out[i] = 1; }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const { return {out + layout(0, j, k)}; }
};

/// Adds 10 at listed cells.
struct AddAtEntry {
  Array<Index> cell;
  Real* out;
  KOKKOS_INLINE_FUNCTION void operator()(Index n) const { out[cell(n)] += 10; }
};

/// Triples rows.
struct TripleRow {
  Layout layout;
  Real* out;
  void finish_row(int j, int k) const {
    for (int i = 0; i < layout.cells[0]; ++i) out[layout(i, j, k)] *= 3;
  }
  void finish() const {
    const TripleRow self = *this;
    for_each_cell(
        "triple", RowRanges(layout.cells),
        KOKKOS_LAMBDA(int i, int j, int k) { self.out[self.layout(i, j, k)] *= 3; });
  }
};

TEST(Sweep, PartsOfAStageFollowEachOther) {
  const Int3 n{5, 4, 6};
  const Layout layout(n);
  const Field<Real> field("field", layout);
  RowChains chains;
  chains.rows_per_plane = n[1];
  chains.first = Array<int>("first", 24);
  chains.next = Array<int>("next", 3);
  Kokkos::deep_copy(chains.first, -1);
  const Array<Index> cells("cells", 3);
  cells(0) = layout(1, 2, 3);  // two in one row
  cells(1) = layout(4, 2, 3);
  cells(2) = layout(0, 0, 5);
  chains.first(2 + 4 * 3) = 1;
  chains.next(1) = 0;
  chains.next(0) = -1;
  chains.first(0 + 4 * 5) = 2;
  chains.next(2) = -1;
  const bool wraps[3] = {false, false, false};
  const Norms norms = sweep("test", SweepPlan(n, Box{{0, 0, 0}, n}, wraps),
                            Stage(RowRanges(n), SetToOne{layout, field.data()},
                                  AtEntries<AddAtEntry>{chains, 3, {cells, field.data()}},
                                  OnRows<TripleRow>{{layout, field.data()}}, Value{layout, field.data()}));
  EXPECT_EQ(norms.sum, 3 * (120 + 30));
  EXPECT_EQ(norms.largest, 33);
  EXPECT_EQ(field(4, 2, 3), 33);
  EXPECT_EQ(field(3, 2, 3), 3);
}

/// Counts the cells that are treated in the way of their vector.
struct CountInEitherWay {
  using Result = Total;
  static constexpr bool may_overrun = false;
  Layout layout;
  Real *plain_cells, *other_cells;

  KOKKOS_INLINE_FUNCTION static bool is_plain(int i, int j, int k) {
    return (i / vector_length + j + 2 * k) % 3 == 0;
  }
  struct Row {
    Real *plain_cells, *other_cells;
    int j, k;
    KOKKOS_INLINE_FUNCTION Real operator()(int i) const {
      other_cells[i] += 1;
      return 1;
    }
    KOKKOS_INLINE_FUNCTION bool is_plain(int i) const { return CountInEitherWay::is_plain(i, j, k); }
    KOKKOS_INLINE_FUNCTION Real plain(int i) const {
      plain_cells[i] += 1;
      return 1000;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    return {plain_cells + layout(0, j, k), other_cells + layout(0, j, k), j, k};
  }
};

TEST(Sweep, TreatsWholeVectorsInThePlainWayWhereTheRowAllowsIt) {
  if (!runs_on_host) GTEST_SKIP() << "no vectors";
  for (const Int3& n : {Int3{5, 4, 3}, Int3{48, 7, 5}, Int3{75, 21, 33}}) {
    const Layout layout(n);
    const Field<Real> plain_cells("plain", layout), other_cells("other", layout);
    const bool wraps[3] = {true, true, true};
    const Total total =
        sweep("test", SweepPlan(n, Box{{0, 0, 0}, n}, wraps),
              Stage{RowRanges(n), CountInEitherWay{layout, plain_cells.data(), other_cells.data()}});
    Real sum = 0;
    for (int k = 0; k < n[2]; ++k)
      for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) {
          const bool in_whole_vector = i / vector_length < n[0] / vector_length;
          const bool is_plain = in_whole_vector && CountInEitherWay::is_plain(i, j, k);
          ASSERT_EQ(plain_cells(i, j, k), is_plain);
          ASSERT_EQ(other_cells(i, j, k), !is_plain);
          sum += is_plain ? 1000 : 1;
        }
    EXPECT_EQ(total.sum, sum);
  }
}

TEST(Sweep, PaddingDoesNotEnterNorms) {
  const Int3 n{21, 5, 6};
  const Field<Real> field("field", Layout(n));
  field.fill(1e30);
  RowRanges rows(n);
  rows.first = Array<int>("first", 30);
  rows.last = Array<int>("last", 30);
  for (int row = 0; row < 30; ++row) {
    rows.first(row) = row % 3;
    rows.last(row) = row == 4 ? 0 : 21 - row % 5;
  }
  Real sum = 0, squares = 0;
  for (int k = 0; k < 6; ++k)
    for (int j = 0; j < 5; ++j)
      for (int i = rows.first(j + 5 * k); i < rows.last(j + 5 * k); ++i) {
        field(i, j, k) = i - 9;
        sum += i - 9;
        squares += (i - 9) * (i - 9);
      }
  const bool wraps[3] = {false, false, false};
  const Norms norms =
      sweep("test", SweepPlan(n, rows.box, wraps), Stage{rows, Value{field.layout(), field.array().data()}});
  EXPECT_EQ(norms.sum, sum);
  EXPECT_EQ(norms.squares, squares);
  EXPECT_EQ(norms.largest, 11);
}

}  // namespace
}  // namespace peclet
