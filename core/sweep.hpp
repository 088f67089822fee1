#pragma once
// Sweeps of several dependent stages over one grid, and reductions that do not depend on the number of
// threads.
//
// A body has a type Result (Nothing, Total or Norms) and a function row(j, k); the object that it returns
// treats cell (i, j, k) by operator()(i) and returns the value to be reduced, if any. In a row the order does
// not matter. A stage may consist of several parts, which treat each row one after the other: bodies,
// AtEntries of a list, and OnRows. A part may read what the parts before it wrote in the same row; the last
// one gives the result. In a sweep each stage may read what the stage before wrote in the same plane and in
// the two planes next to it, and may overwrite what the stage before read.
//
// On the host the stages follow each other at a distance of one plane, so that a plane is still in the cache
// when the next stage needs it. Every thread walks through its own slab; what depends on two slabs is left
// out at first and done in a second round. On a device every part is a kernel of its own.
#include <algorithm>
#include <tuple>
#include <type_traits>
#include <utility>
#include <vector>

#include "core/sweep_stage.hpp"

namespace peclet {

/// The order in which the host walks through a grid, and the memory that the reductions need.
class SweepPlan {
 public:
  SweepPlan() = default;
  /// wraps: which axes are periodic. Planes 2 I - shift and the one after it are never parted.
  SweepPlan(const Int3& cells, const Box& box, const bool (&wraps)[3], const Int3& shift = {0, 0, 0});

  int axis() const { return axis_; }
  int low() const { return low_; }
  int high() const { return high_; }
  bool wraps() const { return wraps_; }
  int wrapped(int plane) const {
    return plane < low_ ? plane + high_ : (plane >= high_ ? plane - high_ : plane);
  }
  /// Slabs for a sweep of that many stages.
  int number_of_slabs(int stages) const;
  /// The slabs of a periodic axis begin at plane shift and end beyond the last one, to be wrapped.
  int slab_begin(int slab, int slabs) const {
    const int begin = low_ + (wraps_ ? shift_ : 0), planes = high_ - low_;
    if (slab == 0 || slab == slabs) return begin + (slab == 0 ? 0 : planes);
    return begin + static_cast<int>(Index{planes} * slab / slabs) / 2 * 2 + (begin + shift_) % 2;
  }
  Norms& result(int plane) const { return results_.data()[plane - low_]; }

 private:
  int axis_ = 2, low_ = 0, high_ = 0, shift_ = 0;
  bool wraps_ = false;
  Index cells_ = 0;
  Kokkos::View<Norms*, Kokkos::HostSpace> results_;
};

inline SweepPlan::SweepPlan(const Int3& cells, const Box& box, const bool (&wraps)[3], const Int3& shift) {
  axis_ = box.extent(2) < 8 && box.extent(1) > box.extent(2) ? 1 : 2;
  low_ = box.low[axis_];
  high_ = box.high[axis_];
  shift_ = shift[axis_];
  wraps_ = wraps[axis_] && box.extent(axis_) == cells[axis_];
  cells_ = box.size();
  results_ = Kokkos::View<Norms*, Kokkos::HostSpace>("sweep_results", high_ - low_);
}

inline int SweepPlan::number_of_slabs(int stages) const {
  if (is_serial_box(cells_)) return 1;
  const int most = (high_ - low_) / (2 * stages);
  return std::max(1, std::min(most, static_cast<int>(ExecutionSpace().concurrency())));
}

namespace detail {

/// Runs stages first <= stage < first + count of a pipeline plane by plane.
template <class Pipeline>
class HostSweep {
 public:
  HostSweep(const SweepPlan& plan, const Pipeline& pipeline, int first, int count)
      : plan_(plan), pipeline_(pipeline), first_(first), count_(count) {}

  void run(const char* label) const {
    const int low = plan_.low(), high = plan_.high();
    const bool wraps = plan_.wraps() && count_ > 1;
    if (high - low < 2 * count_) {
      for (int stage = 0; stage < count_; ++stage)
        for (int plane = low; plane < high; ++plane) run_stage(stage, plane);
      return;
    }
    const int slabs = plan_.number_of_slabs(count_);
    const auto walk = [this, slabs, wraps](Index slab) { walk_slab(static_cast<int>(slab), slabs, wraps); };
    const auto close = [this, slabs, wraps](Index gap) {
      if (gap > 0 || wraps) close_gap(plan_.slab_begin(static_cast<int>(gap), slabs));
    };
    for_each_task(label, slabs, walk);
    if (count_ > 1) for_each_task(label, slabs, close);
  }

 private:
  void run_stage(int stage, int plane) const { pipeline_.run(plan_, first_ + stage, plan_.wrapped(plane)); }

  /// Stage s leaves out s planes at the ends where another slab follows.
  void walk_slab(int slab, int slabs, bool wraps) const {
    const int begin = plan_.slab_begin(slab, slabs), end = plan_.slab_begin(slab + 1, slabs);
    const int open_low = slab > 0 || wraps, open_high = slab + 1 < slabs || wraps;
    for (int step = begin; step < end + count_ - 1; ++step)
      for (int stage = 0; stage < count_; ++stage) {
        const int plane = step - stage;
        if (plane >= begin + stage * open_low && plane < end - stage * open_high) run_stage(stage, plane);
      }
  }

  /// What the slabs on both sides of a plane left out.
  void close_gap(int middle) const {
    for (int stage = 0; stage < count_; ++stage)
      for (int plane = middle - stage; plane < middle + stage; ++plane) run_stage(stage, plane);
  }

  const SweepPlan& plan_;
  const Pipeline& pipeline_;
  int first_, count_;
};

template <class Stage>
void run_and_keep_result(const SweepPlan& plan, const Stage& stage, int plane) {
  const auto result = stage.run_plane(plan.axis(), plane);
  if constexpr (std::is_same_v<typename Stage::Result, Total>) plan.result(plane).sum = result.sum;
  if constexpr (std::is_same_v<typename Stage::Result, Norms>) plan.result(plane) = result;
}

/// Sums over planes in order, whoever computed them.
template <class Result>
Result collect(const SweepPlan& plan) {
  Norms all;
  if constexpr (!std::is_same_v<Result, Nothing>)
    for (int plane = plan.low(); plane < plan.high(); ++plane) all.join(plan.result(plane));
  if constexpr (std::is_same_v<Result, Nothing>)
    return {};
  else if constexpr (std::is_same_v<Result, Total>)
    return {all.sum};
  else
    return all;
}

template <class... Stages>
struct StageTuple {
  static constexpr int count = sizeof...(Stages);
  using Result = typename std::tuple_element_t<count - 1, std::tuple<Stages...>>::Result;
  std::tuple<const Stages&...> stages;

  void run(const SweepPlan& plan, int stage, int plane) const {
    dispatch(plan, stage, plane, std::make_integer_sequence<int, count>());
  }

 private:
  template <int... I>
  void dispatch(const SweepPlan& plan, int stage, int plane, std::integer_sequence<int, I...>) const {
    (run_if<I>(plan, stage, plane), ...);
  }
  template <int I>
  void run_if(const SweepPlan& plan, int stage, int plane) const {
    if (stage != I) return;
    if constexpr (I == count - 1)
      run_and_keep_result(plan, std::get<I>(stages), plane);
    else
      std::get<I>(stages).run_plane(plan.axis(), plane);
  }
};

template <class First, class Repeated, class Last>
struct StageSeries {
  const First& first;
  const std::vector<Repeated>& repeated;
  const Last& last;

  void run(const SweepPlan& plan, int stage, int plane) const {
    if (stage == 0)
      first.run_plane(plan.axis(), plane);
    else if (stage <= static_cast<int>(repeated.size()))
      repeated[stage - 1].run_plane(plan.axis(), plane);
    else
      run_and_keep_result(plan, last, plane);
  }
};

/// Stages of a series that follow each other through the grid at once: so few that what they share stays in
/// the cache and that every thread has planes of its own.
inline int stages_at_once(const SweepPlan& plan) {
  constexpr int cached = 8;
  const int threads = static_cast<int>(ExecutionSpace().concurrency());
  return std::clamp((plan.high() - plan.low()) / (2 * threads), 1, cached);
}

}  // namespace detail

/// Runs the stages one after the other and returns the result of the last one.
template <class... Stages>
auto sweep(const char* label, const SweepPlan& plan, const Stages&... stages) {
  using Pipeline = detail::StageTuple<Stages...>;
  using Result = typename Pipeline::Result;
  if constexpr (runs_on_host) {
    const Pipeline pipeline{{stages...}};
    detail::HostSweep<Pipeline>(plan, pipeline, 0, Pipeline::count).run(label);
    return detail::collect<Result>(plan);
  } else {
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

/// Runs first, then repeated(m) for 0 <= m < repetitions, then last, and returns the result of the last one.
template <class First, class Repeated, class Last>
typename Last::Result sweep_series(const char* label, const SweepPlan& plan, const First& first,
                                   int repetitions, const Repeated& repeated, const Last& last) {
  if constexpr (runs_on_host) {
    using Middle = decltype(repeated(0));
    using Pipeline = detail::StageSeries<First, Middle, Last>;
    std::vector<Middle> middle;  // made once: copying a stage for every plane counts references to its views
    middle.reserve(repetitions);
    for (int m = 0; m < repetitions; ++m) middle.push_back(repeated(m));
    const Pipeline pipeline{first, middle, last};
    const int stages = repetitions + 2, at_once = detail::stages_at_once(plan);
    for (int done = 0; done < stages; done += at_once)
      detail::HostSweep<Pipeline>(plan, pipeline, done, std::min(at_once, stages - done)).run(label);
    return detail::collect<typename Last::Result>(plan);
  } else {
    first.launch(label);
    for (int m = 0; m < repetitions; ++m) repeated(m).launch(label);
    return last.launch(label);
  }
}

}  // namespace peclet
