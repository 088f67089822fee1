#pragma once
// Weights of the scheme in time of flow/momentum.hpp, which scalars follow too.
#include "core/types.hpp"

namespace peclet::flow {

/// Implicit weight of diffusion from the second step on.
inline constexpr Real second_order_weight = 9.0 / 16.0;

/// Share of the extrapolation for a ratio r of two time steps.
inline Real share_of_past(Real ratio) { return ratio > 2 ? 4 / (ratio * ratio) : 1; }

}  // namespace peclet::flow
