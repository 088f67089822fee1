#pragma once
// What a sweep does with a plane: bodies and lists on rows, with reductions whose result does not depend on
// the number of threads.
#include <algorithm>
#include <tuple>
#include <type_traits>
#include <utility>

#include "core/loop.hpp"

namespace peclet {

struct Nothing {
  void join(const Nothing&) {}
};

/// Sum of what the body returns.
struct Total {
  Real sum = 0;
  void join(const Total& other) { sum += other.sum; }
};

/// Sum, sum of squares and largest magnitude of what the body returns.
struct Norms {
  Real sum = 0, squares = 0, largest = 0;
  void join(const Norms& other) {
    sum += other.sum;
    squares += other.squares;
    largest = other.largest > largest ? other.largest : largest;
  }
};

/// Cells of a row that the host treats together. A body with may_overrun is also called for the cells between
/// the end of the row and the next multiple of this; it must accept to read and write there (ghosts, padding
/// and the low ghosts of the next row), and what it returns for them does not count.
inline constexpr int vector_length = Layout::alignment;

/// A row may know a shorter way for the cells of a whole vector, plain(i), where is_plain(i) holds for the
/// first of them: the same as operator() but for rounding.
template <class Row>
inline constexpr bool has_plain_vectors = requires(const Row& row) { row.is_plain(0); };

namespace detail {

/// Reductions are carried in one accumulator per vector lane: over a row in the arithmetic of the body, over
/// a plane in double precision.
template <class Result, class T>
struct RowLanes;

template <class T>
struct RowLanes<Total, T> {
  T sum[vector_length] = {};
  void add(const T (&values)[vector_length]) {
#pragma omp simd
    for (int lane = 0; lane < vector_length; ++lane) sum[lane] += values[lane];
  }
};

template <class T>
struct RowLanes<Norms, T> {
  T sum[vector_length] = {}, squares[vector_length] = {}, largest[vector_length] = {};
  void add(const T (&values)[vector_length]) {
#pragma omp simd
    for (int lane = 0; lane < vector_length; ++lane) {
      const T value = values[lane], magnitude = Kokkos::fabs(value);
      sum[lane] += value;
      squares[lane] += value * value;
      largest[lane] = magnitude > largest[lane] ? magnitude : largest[lane];
    }
  }
};

template <class Result>
struct Lanes;

template <>
struct Lanes<Nothing> {
  Nothing result() const { return {}; }
};

template <>
struct Lanes<Total> {
  Real sum[vector_length] = {};

  template <class T>
  void add(const RowLanes<Total, T>& row) {
#pragma omp simd
    for (int lane = 0; lane < vector_length; ++lane) sum[lane] += row.sum[lane];
  }
  Total result() const {
    Total total;
    for (const Real value : sum) total.sum += value;
    return total;
  }
};

template <>
struct Lanes<Norms> {
  Real sum[vector_length] = {}, squares[vector_length] = {}, largest[vector_length] = {};

  template <class T>
  void add(const RowLanes<Norms, T>& row) {
#pragma omp simd
    for (int lane = 0; lane < vector_length; ++lane) {
      sum[lane] += row.sum[lane];
      squares[lane] += row.squares[lane];
      largest[lane] = row.largest[lane] > largest[lane] ? row.largest[lane] : largest[lane];
    }
  }
  Norms result() const {
    Norms total;
    for (int lane = 0; lane < vector_length; ++lane) total.join({sum[lane], squares[lane], largest[lane]});
    return total;
  }
};

}  // namespace detail

/// Entries of a list that belong to cells, chained per row of cells: first, then next until negative.
struct RowChains {
  Array<int> first, next;
  int rows_per_plane = 0;

  KOKKOS_INLINE_FUNCTION Index row(int j, int k) const { return j + static_cast<Index>(k) * rows_per_plane; }
};

/// Part of a stage: body(n) for the entries of a list, in no particular order.
template <class Body>
struct AtEntries {
  using Result = Nothing;
  RowChains chains;
  Index count;
  Body body;
};

/// Part of a stage: body.finish_row(j, k) after each row, empty ones included, on the host; body.finish()
/// once all are done on a device.
template <class Body>
struct OnRows {
  using Result = Nothing;
  Body body;
};

namespace detail {

/// The cells of the vector that begins at i; values get what cell returns, if anything.
template <class Row, class T>
inline void run_vector(const Row& cell, int i, T* values) {
  constexpr bool returns = !std::is_void_v<T>;
  if constexpr (has_plain_vectors<Row>) {
    if (cell.is_plain(i)) {
#pragma omp simd
      for (int lane = 0; lane < vector_length; ++lane) {
        if constexpr (returns)
          values[lane] = cell.plain(i + lane);
        else
          cell.plain(i + lane);
      }
      return;
    }
  }
#pragma omp simd
  for (int lane = 0; lane < vector_length; ++lane) {
    if constexpr (returns)
      values[lane] = cell(i + lane);
    else
      cell(i + lane);
  }
}

template <class Body>
void run_row(const Body& body, int first, int last, int j, int k, bool may_overrun,
             Lanes<typename Body::Result>& plane) {
  using Result = typename Body::Result;
  const bool overruns = Body::may_overrun && may_overrun;
  if (first >= last) return;
  const auto cell = body.row(j, k);
  int i = first;
  if constexpr (std::is_same_v<Result, Nothing>) {
    for (; i + vector_length <= last || (overruns && i < last); i += vector_length)
      run_vector<decltype(cell), void>(cell, i, nullptr);
    for (; i < last; ++i) cell(i);
  } else {
    using T = decltype(cell(0));
    RowLanes<Result, T> sums;
    T values[vector_length];
    for (; i + vector_length <= last; i += vector_length) {
      run_vector(cell, i, values);
      sums.add(values);
    }
    if (i < last) {
      const int rest = last - i;
      if (overruns) {
#pragma omp simd
        for (int lane = 0; lane < vector_length; ++lane) values[lane] = cell(i + lane);
      } else {
        for (int lane = 0; lane < rest; ++lane) values[lane] = cell(i + lane);
      }
      for (int lane = rest; lane < vector_length; ++lane) values[lane] = 0;
      sums.add(values);
    }
    plane.add(sums);
  }
}

template <class Body>
void run_row(const AtEntries<Body>& part, int first, int last, int j, int k, bool, Lanes<Nothing>&) {
  if (part.count == 0 || first >= last) return;
  for (int n = part.chains.first.data()[part.chains.row(j, k)]; n >= 0; n = part.chains.next.data()[n])
    part.body(n);
}

template <class Body>
void run_row(const OnRows<Body>& part, int, int, int j, int k, bool, Lanes<Nothing>&) {
  part.body.finish_row(j, k);
}

template <class Body>
Nothing launch_kernel(const char* label, const RowRanges& rows, const Body& body, Nothing) {
  for_each_cell(label, rows, KOKKOS_LAMBDA(int i, int j, int k) { body.row(j, k)(i); });
  return {};
}
template <class Body>
Total launch_kernel(const char* label, const RowRanges& rows, const Body& body, Total) {
  return {sum_cells(label, rows, KOKKOS_LAMBDA(int i, int j, int k)->Real { return body.row(j, k)(i); })};
}
template <class Body>
Norms launch_kernel(const char* label, const RowRanges& rows, const Body& body, Norms) {
  Norms norms;
  reduce_cells(
      label, rows,
      KOKKOS_LAMBDA(int i, int j, int k, Real& sum, Real& squares, Real& largest) {
        const Real value = body.row(j, k)(i);
        sum += value;
        squares += value * value;
        largest = Kokkos::fmax(largest, Kokkos::fabs(value));
      },
      norms.sum, norms.squares, norms.largest);
  return norms;
}

template <class Body>
typename Body::Result launch_part(const char* label, const RowRanges& rows, const Body& body) {
  return launch_kernel(label, rows, body, typename Body::Result());
}
template <class Body>
Nothing launch_part(const char* label, const RowRanges&, const AtEntries<Body>& part) {
  const Body body = part.body;
  for_each(label, part.count, KOKKOS_LAMBDA(Index n) { body(n); });
  return {};
}
template <class Body>
Nothing launch_part(const char*, const RowRanges&, const OnRows<Body>& part) {
  part.body.finish();
  return {};
}

}  // namespace detail

/// The parts on every row of the ranges, one after the other.
template <class... Parts>
struct Stage {
  using Result = typename std::tuple_element_t<sizeof...(Parts) - 1, std::tuple<Parts...>>::Result;
  RowRanges rows;
  std::tuple<Parts...> parts;

  explicit Stage(const RowRanges& ranges, const Parts&... all) : rows(ranges), parts(all...) {}

  Result run_plane(int axis, int plane) const;
  Result launch(const char* label) const;

 private:
  template <std::size_t... I>
  void run_parts(int first, int last, int j, int k, bool may_overrun,
                 std::tuple<detail::Lanes<typename Parts::Result>...>& lanes,
                 std::index_sequence<I...>) const {
    (detail::run_row(std::get<I>(parts), first, last, j, k, may_overrun, std::get<I>(lanes)), ...);
  }
};

template <class... Parts>
typename Stage<Parts...>::Result Stage<Parts...>::run_plane(int axis, int plane) const {
  const Box& box = rows.box;
  if (plane < box.low[axis] || plane >= box.high[axis]) return {};
  const int across = 3 - axis;
  const bool may_overrun = axis == 2;  // else the next row, in another plane, may be done already
  const Index ny = box.extent(1);
  std::tuple<detail::Lanes<typename Parts::Result>...> lanes;
  for (int m = box.low[across]; m < box.high[across]; ++m) {
    const int j = axis == 1 ? plane : m, k = axis == 1 ? m : plane;
    const Index row = (j - box.low[1]) + (k - box.low[2]) * ny;
    run_parts(rows.begin(row), rows.end(row), j, k, may_overrun, lanes, std::index_sequence_for<Parts...>());
  }
  return std::get<sizeof...(Parts) - 1>(lanes).result();
}

template <class... Parts>
typename Stage<Parts...>::Result Stage<Parts...>::launch(const char* label) const {
  return std::apply(
      [&](const auto&... all) {
        std::tuple<typename Parts::Result...> results{detail::launch_part(label, rows, all)...};
        return std::get<sizeof...(Parts) - 1>(results);
      },
      parts);
}

/// A stage on the fine grid and, as soon as all children of a coarse plane are done, one on the coarse grid.
/// An even number of stages goes before it.
template <class FineStage, class CoarseStage>
struct CoarseningStage {
  using Result = Nothing;
  FineStage fine;
  CoarseStage coarse;
  Int3 ratio;              ///< fine cells per coarse cell, 1 or 2
  Int3 shift = {0, 0, 0};  ///< 2 I - shift is the first child of coarse cell I

  Result run_plane(int axis, int plane) const {
    fine.run_plane(axis, plane);
    const int shifted = plane + shift[axis];
    const bool completes_pair = shifted % 2 == 1 || plane == fine.rows.box.high[axis] - 1;
    if (ratio[axis] == 1 || completes_pair) coarse.run_plane(axis, shifted / ratio[axis]);
    return {};
  }
  Result launch(const char* label) const {
    fine.launch(label);
    coarse.launch(label);
    return {};
  }
};
template <class FineStage, class CoarseStage>
CoarseningStage(FineStage, CoarseStage, Int3, Int3) -> CoarseningStage<FineStage, CoarseStage>;

}  // namespace peclet
