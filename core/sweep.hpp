#pragma once
// Sweeps of several dependent stages over one grid, and reductions that do not depend on the number of
// threads.
//
// A body has a type Result (Nothing, Total or Norms) and a function row(j, k); the object that it returns
// treats cell (i, j, k) by operator()(i) and returns the value to be reduced, if any. In a row the order does
// not matter. In a sweep each stage may read what the stage before wrote in the same plane and in the two
// planes next to it, and may overwrite what the stage before read.
//
// On the host the stages follow each other at a distance of one plane, so that a plane is still in the cache
// when the next stage needs it. Every thread walks through its own slab; what depends on two slabs is left
// out at first and done in a second round. On a device the stages are kernels of their own.
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

namespace detail {

/// Reductions are carried in one accumulator per vector lane: over a row in the arithmetic of the body, over
/// a plane in double precision.
template <class Result, class T>
struct RowLanes;

template <class T>
struct RowLanes<Total, T> {
  T sum[vector_length] = {};
  void add(int lane, T value) { sum[lane] += value; }
};

template <class T>
struct RowLanes<Norms, T> {
  T sum[vector_length] = {}, squares[vector_length] = {}, largest[vector_length] = {};
  void add(int lane, T value) {
    const T magnitude = value < 0 ? -value : value;
    sum[lane] += value;
    squares[lane] += value * value;
    largest[lane] = magnitude > largest[lane] ? magnitude : largest[lane];
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

/// The body for every cell of the ranges.
template <class Body>
struct Stage {
  using Result = typename Body::Result;
  RowRanges rows;
  Body body;

  void run_row(Index row, int j, int k, detail::Lanes<Result>& plane) const;
  Result run_plane(int axis, int plane) const;
  Result launch(const char* label) const;
};
template <class Body>
Stage(RowRanges, Body) -> Stage<Body>;

/// A stage on the fine grid and, as soon as all children of a coarse plane are done, one on the coarse grid.
template <class Fine, class Coarse>
struct CoarseningStage {
  using Result = Nothing;
  Stage<Fine> fine;
  Stage<Coarse> coarse;
  Int3 ratio;  ///< fine cells per coarse cell, 1 or 2

  Result run_plane(int axis, int plane) const {
    fine.run_plane(axis, plane);
    const bool completes_pair = plane % 2 == 1 || plane == fine.rows.box.high[axis] - 1;
    if (ratio[axis] == 1 || completes_pair) coarse.run_plane(axis, plane / ratio[axis]);
    return {};
  }
  Result launch(const char* label) const {
    fine.launch(label);
    coarse.launch(label);
    return {};
  }
};
template <class Fine, class Coarse>
CoarseningStage(Stage<Fine>, Stage<Coarse>, Int3) -> CoarseningStage<Fine, Coarse>;

/// The order in which the host walks through a grid, and the memory that the reductions need.
class SweepPlan {
 public:
  SweepPlan() = default;
  /// wraps: which axes are periodic.
  SweepPlan(const Int3& cells, const Box& box, const bool (&wraps)[3]);

  int axis() const { return axis_; }
  int low() const { return low_; }
  int high() const { return high_; }
  bool wraps() const { return wraps_; }
  int wrapped(int plane) const {
    return plane < low_ ? plane + high_ : (plane >= high_ ? plane - high_ : plane);
  }
  /// Slabs for a sweep of that many stages; they start at even planes.
  int number_of_slabs(int stages) const;
  int slab_begin(int slab, int slabs) const {
    if (slab == slabs) return high_;
    return slab == 0 ? low_
                     : low_ + static_cast<int>(Index{high_ - low_} * slab / slabs) / 2 * 2 + (low_ % 2);
  }
  Norms& result(int plane) const { return results_.data()[plane - low_]; }

 private:
  int axis_ = 2, low_ = 0, high_ = 0;
  bool wraps_ = false;
  Index cells_ = 0;
  Kokkos::View<Norms*, Kokkos::HostSpace> results_;
};

inline SweepPlan::SweepPlan(const Int3& cells, const Box& box, const bool (&wraps)[3]) {
  axis_ = box.extent(2) < 8 && box.extent(1) > box.extent(2) ? 1 : 2;
  low_ = box.low[axis_];
  high_ = box.high[axis_];
  wraps_ = wraps[axis_] && box.extent(axis_) == cells[axis_];
  cells_ = box.size();
  results_ = Kokkos::View<Norms*, Kokkos::HostSpace>("sweep_results", high_ - low_);
}

/// Below this size one thread is faster than several.
inline constexpr Index smallest_parallel_sweep = 8192;

inline int SweepPlan::number_of_slabs(int stages) const {
  if (cells_ < smallest_parallel_sweep) return 1;
  const int most = (high_ - low_) / (2 * stages);
  return std::max(1, std::min(most, static_cast<int>(ExecutionSpace().concurrency())));
}

template <class Body>
void Stage<Body>::run_row(Index row, int j, int k, detail::Lanes<Result>& plane) const {
  const int first = rows.begin(row), last = rows.end(row);
  if (first >= last) return;
  const auto cell = body.row(j, k);
  int i = first;
  if constexpr (std::is_same_v<Result, Nothing>) {
    for (; i + vector_length <= last || (Body::may_overrun && i < last); i += vector_length) {
#pragma omp simd
      for (int lane = 0; lane < vector_length; ++lane) cell(i + lane);
    }
    for (; i < last; ++i) cell(i);
  } else {
    detail::RowLanes<Result, decltype(cell(0))> sums;
    for (; i + vector_length <= last || (Body::may_overrun && i < last); i += vector_length) {
#pragma omp simd
      for (int lane = 0; lane < vector_length; ++lane) {
        const auto value = cell(i + lane);
        sums.add(lane, i + lane < last ? value : 0);
      }
    }
    for (int lane = 0; i < last; ++i, ++lane) sums.add(lane, cell(i));
    plane.add(sums);
  }
}

template <class Body>
typename Stage<Body>::Result Stage<Body>::run_plane(int axis, int plane) const {
  const Box& box = rows.box;
  if (plane < box.low[axis] || plane >= box.high[axis]) return {};
  const int across = 3 - axis;
  const Index ny = box.extent(1);
  detail::Lanes<Result> lanes;
  for (int m = box.low[across]; m < box.high[across]; ++m) {
    const int j = axis == 1 ? plane : m, k = axis == 1 ? m : plane;
    run_row((j - box.low[1]) + (k - box.low[2]) * ny, j, k, lanes);
  }
  return lanes.result();
}

namespace detail {

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

}  // namespace detail

template <class Body>
typename Stage<Body>::Result Stage<Body>::launch(const char* label) const {
  return detail::launch_kernel(label, rows, body, Result());
}

namespace detail {

template <class... Stages>
class HostSweep {
 public:
  static constexpr int count = sizeof...(Stages);
  using Result = typename std::tuple_element_t<count - 1, std::tuple<Stages...>>::Result;

  HostSweep(const SweepPlan& plan, const Stages&... stages) : plan_(plan), stages_(stages...) {}

  Result run(const char* label) const {
    const int low = plan_.low(), high = plan_.high();
    const bool wraps = plan_.wraps() && count > 1;
    if (high <= low) return {};
    if (high - low < 2 * count) {
      for_each_stage([&](auto stage) {
        for (int plane = low; plane < high; ++plane) run_stage<stage>(plane);
      });
      return collect();
    }
    const int slabs = plan_.number_of_slabs(count);
    const auto walk = [this, slabs, wraps](Index slab) { walk_slab(static_cast<int>(slab), slabs, wraps); };
    const auto close = [this, slabs, wraps](Index gap) {
      if (gap > 0 || wraps) close_gap(plan_.slab_begin(static_cast<int>(gap), slabs));
    };
    if (slabs == 1) {
      walk(0);
      close(0);
    } else {
      for_each(label, slabs, walk);
      if (count > 1) for_each(label, slabs, close);
    }
    return collect();
  }

 private:
  template <int I>
  void run_stage(int plane) const {
    const auto result = std::get<I>(stages_).run_plane(plan_.axis(), plane);
    if constexpr (I == count - 1 && std::is_same_v<Result, Total>) plan_.result(plane).sum = result.sum;
    if constexpr (I == count - 1 && std::is_same_v<Result, Norms>) plan_.result(plane) = result;
  }

  template <class Action>
  static void for_each_stage(const Action& action) {
    for_each_stage(action, std::make_integer_sequence<int, count>());
  }
  template <class Action, int... I>
  static void for_each_stage(const Action& action, std::integer_sequence<int, I...>) {
    (action(std::integral_constant<int, I>()), ...);
  }

  /// Stage s leaves out s planes at the ends where another slab follows.
  void walk_slab(int slab, int slabs, bool wraps) const {
    const int begin = plan_.slab_begin(slab, slabs), end = plan_.slab_begin(slab + 1, slabs);
    const int open_low = slab > 0 || wraps, open_high = slab + 1 < slabs || wraps;
    for (int step = begin; step < end + count - 1; ++step)
      for_each_stage([&](auto stage) {
        const int plane = step - stage;
        if (plane >= begin + stage * open_low && plane < end - stage * open_high) run_stage<stage>(plane);
      });
  }

  /// What the slabs on both sides of a plane left out.
  void close_gap(int middle) const {
    for_each_stage([&](auto stage) {
      for (int plane = middle - stage; plane < middle + stage; ++plane)
        run_stage<stage>(plan_.wrapped(plane));
    });
  }

  /// Sums over planes in order, whoever computed them.
  Result collect() const {
    Norms all;
    if constexpr (!std::is_same_v<Result, Nothing>)
      for (int plane = plan_.low(); plane < plan_.high(); ++plane) all.join(plan_.result(plane));
    if constexpr (std::is_same_v<Result, Nothing>)
      return {};
    else if constexpr (std::is_same_v<Result, Total>)
      return {all.sum};
    else
      return all;
  }

  const SweepPlan& plan_;
  std::tuple<const Stages&...> stages_;
};

}  // namespace detail

/// Runs the stages one after the other and returns the result of the last one.
template <class... Stages>
auto sweep(const char* label, const SweepPlan& plan, const Stages&... stages) {
  if constexpr (runs_on_host) {
    return detail::HostSweep<Stages...>(plan, stages...).run(label);
  } else {
    using Result = typename detail::HostSweep<Stages...>::Result;
    Result result;
    const auto launch = [&](const auto& stage) {
      if constexpr (std::is_same_v<decltype(stage.launch(label)), Result>)
        result = stage.launch(label);
      else
        stage.launch(label);
    };
    (launch(stages), ...);
    return result;
  }
}

}  // namespace peclet
