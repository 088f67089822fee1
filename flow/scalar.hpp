#pragma once
// One transported scalar (temperature, concentration): what a user chooses, and its fields.
//   dc/dt + div(u c) = D lap c + s    in the fluid,   c or its flux given on walls and sides
#include <string>
#include <vector>

#include "core/field.hpp"
#include "flow/bodies.hpp"
#include "flow/open_fraction.hpp"
#include "flow/settings.hpp"
#include "flow/wall_rows.hpp"

namespace peclet::flow {

/// Value that is carried through a face.
enum class ScalarScheme {
  FirstUpwind,
  SecondUpwind,
  Koren,  // third-order upwind-biased, limited: no new extrema up to a CFL number of 1/2 [Koren1993]
};

enum class ScalarCondition {
  Flux,   // Neumann: flux into the fluid per area
  Value,  // Dirichlet
};

/// Condition on the surface of a body.
struct ScalarWall {
  ScalarCondition condition = ScalarCondition::Flux;
  Real value = 0;
};

/// Condition on a side of the box; a periodic one has none.
struct ScalarSide {
  bool is_periodic = true, is_given = false;
  ScalarCondition condition = ScalarCondition::Flux;
  Real value = 0;
  /// Value of face (s, t) at s + size_s t, s along the lower and t along the higher of the two other axes,
  /// instead of a uniform one, if allocated.
  Array<Real> profile;
  int size_s = 0;

  KOKKOS_INLINE_FUNCTION Real at(int s, int t) const {
    return profile.data() ? profile.data()[s + static_cast<Index>(size_s) * t] : value;
  }
};

/// Low and high side of each axis.
struct ScalarSides {
  ScalarSide side[3][2];

  KOKKOS_INLINE_FUNCTION Real value(int axis, int high, const Int3& cell) const {
    return side[axis][high].at(cell[axis == 0 ? 1 : 0], cell[axis == 2 ? 1 : 2]);
  }
  Periodicity periodicity() const {
    Periodicity periodic;
    for (int a = 0; a < 3; ++a) periodic.axis[a] = side[a][0].is_periodic;
    return periodic;
  }
};

struct ScalarSettings {
  Real diffusivity = 0;
  ScalarScheme scheme = ScalarScheme::Koren;
  Real source = 0;               // per volume and time, everywhere
  Real3 mean_gradient{0, 0, 0};  // of the field whose periodic part is transported
  Real tolerance = 1e-8;         // largest residual over the largest deviation from the mean
  int iteration_limit = 200;
};

/// What a cell is to a scalar.
namespace cell_state {
inline constexpr OpenFraction solid = 0;  // no unknown
inline constexpr OpenFraction whole = 2;  // its centre is fluid; walls of given value are at their distance
inline constexpr OpenFraction cut = 4;    // the fluid part of a cell beside a wall of given flux
}  // namespace cell_state

/// Who gives to the fluid: bodies from 0, sampled_solid, or a side of the box.
KOKKOS_INLINE_FUNCTION int side_giver(int axis, int high) { return -3 - (2 * axis + high); }
/// Place of a giver in a list of the bodies, the sampled solid, and the six sides.
KOKKOS_INLINE_FUNCTION int giver_index(int giver, int bodies) {
  return giver >= 0 ? giver : bodies - giver - 2;
}
inline constexpr int givers_besides_bodies = 7;

}  // namespace peclet::flow
