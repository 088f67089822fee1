#pragma once
// Open part of the faces between cells: the coefficients of the pressure operator.
#include <cstdint>

#include "core/field.hpp"
#include "core/types.hpp"

namespace peclet::flow {

/// Open (fluid) part of a face, in units of 1/32768: 0 closed, 32768 fully open. The operator is defined by
/// these integers, so that its meaning does not depend on where or how often they are read.
/// An odd number marks a slit: open in part although the centre of the face is solid (flow/slits.hpp).
using OpenFraction = std::uint16_t;
inline constexpr OpenFraction fully_open = 32768;
inline constexpr Real open_fraction_unit = 1.0 / 32768;

/// 1 where the centre of a face is fluid: a point with a momentum equation. Arithmetic and no choice, because
/// selecting by 16-bit integers vectorises badly.
KOKKOS_INLINE_FUNCTION int is_fluid(OpenFraction open) { return (open < 1 ? open : 1) & ~open; }

KOKKOS_INLINE_FUNCTION bool is_slit(OpenFraction open) { return open & 1; }

/// Whether any face of cell p is open.
KOKKOS_INLINE_FUNCTION bool is_open_cell(const FaceVector<OpenFraction>& open, Index p) {
  bool any = false;
  for (int a = 0; a < 3; ++a) any = any || open[a][p] || open[a][p + open.x.layout().stride(a)];
  return any;
}

/// What lies beyond a side of the box, for the pressure.
enum class PressureSide {
  Periodic,  ///< the opposite side
  Closed,    ///< no flux: wall or inflow
  Fixed      ///< zero on the boundary face: outflow
};

/// Low and high side of each axis.
struct PressureSides {
  PressureSide side[3][2] = {{PressureSide::Periodic, PressureSide::Periodic},
                             {PressureSide::Periodic, PressureSide::Periodic},
                             {PressureSide::Periodic, PressureSide::Periodic}};

  KOKKOS_INLINE_FUNCTION bool is_periodic(int axis) const { return side[axis][0] == PressureSide::Periodic; }
};

}  // namespace peclet::flow
