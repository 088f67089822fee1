#pragma once
// Wall time of a part of the step.
#include "core/types.hpp"

namespace peclet::flow {

/// Adds the time since its construction to a counter when it goes out of scope.
class Stopwatch {
 public:
  explicit Stopwatch(double& seconds) : seconds_(seconds) {}
  Stopwatch(const Stopwatch&) = delete;
  Stopwatch& operator=(const Stopwatch&) = delete;
  ~Stopwatch() {
    Kokkos::fence("flow::stopwatch");
    seconds_ += timer_.seconds();
  }

 private:
  double& seconds_;
  Kokkos::Timer timer_;
};

}  // namespace peclet::flow
