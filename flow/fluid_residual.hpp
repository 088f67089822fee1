#pragma once
// Part of a stage: norms of a residual over the fluid points.
#include "core/field.hpp"
#include "core/sweep_stage.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

struct FluidResidual {
  using Result = Norms;
  static constexpr bool may_overrun = true;
  Layout layout;
  const OpenFraction* open;
  const Real* residual;

  struct Row {
    const OpenFraction* open;
    const Real* residual;
    KOKKOS_INLINE_FUNCTION Real operator()(int i) const { return is_fluid(open[i]) * residual[i]; }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {open + n, residual + n};
  }
};

}  // namespace peclet::flow
