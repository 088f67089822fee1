#pragma once
// What holds on the six sides of the box, and the ghost layers that express it.
//
// The normal velocity component has points on a side: index 0 on the low one, index n on the high one. Where
// the side prescribes them they are no unknowns; on an Outflow side they are, with the pressure zero on the
// side. Tangential components and cell values lie half a cell inside.
#include "core/field.hpp"
#include "core/halo.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

enum class SideKind {
  Periodic,
  Wall,     // no slip; may slide along itself
  Inflow,   // prescribed velocity
  Outflow,  // zero pressure and zero normal derivative of the velocity; what flows back carries no momentum
  Slip,     // symmetry plane
};

struct DomainSide {
  SideKind kind = SideKind::Periodic;
  Vec3 velocity;
  /// Velocity per face of the side instead of a uniform one, if allocated: component c of face (s, t) at
  /// s + size_s (t + size_t c), s along the lower and t along the higher of the two other axes.
  Array<Real> profile;
  int size_s = 0, size_t = 0;

  KOKKOS_INLINE_FUNCTION bool prescribes_velocity() const {
    return kind == SideKind::Wall || kind == SideKind::Inflow;
  }
  /// Component c at the face (s, t), indices clamped to the side.
  KOKKOS_INLINE_FUNCTION Real velocity_at(int c, int s, int t) const {
    if (!profile.data()) return velocity[c];
    s = s < 0 ? 0 : (s < size_s ? s : size_s - 1);
    t = t < 0 ? 0 : (t < size_t ? t : size_t - 1);
    return profile.data()[s + size_s * (t + static_cast<Index>(size_t) * c)];
  }
};

/// Low and high side of each axis.
struct DomainSides {
  DomainSide side[3][2];

  KOKKOS_INLINE_FUNCTION bool is_periodic(int axis) const { return side[axis][0].kind == SideKind::Periodic; }
  /// Whether index n of a face along axis lies on a side of the box: no wall of a body there.
  KOKKOS_INLINE_FUNCTION bool is_side(int axis, int n, const Int3& cells) const {
    return (n == 0 || n == cells[axis]) && !is_periodic(axis);
  }
  bool any(SideKind kind) const;
  /// Throws unless periodic sides come in pairs.
  void require_pairs() const;
  Periodicity periodicity() const;
  PressureSides pressure_sides() const;
  bool same_kinds(const DomainSides& other) const;
};

/// Cells whose low face along c is a velocity point that may be unknown: rows of cells, and one layer more
/// where the high side along c is an Outflow.
RowRanges velocity_rows(const RowRanges& cells, const DomainSides& sides, const Int3& n, int c);

/// Ghosts of a value at cell centres: periodic copies, else mirrored.
template <class T>
void fill_mirrored_ghosts(const Field<T>& field, const DomainSides& sides, int width = Layout::ghost_width);

/// Prescribed points of the sides, and ghosts of velocity component c. Tangential values follow the parabola
/// through the side and two points: exact for quadratic profiles. Component order does not matter, but the
/// ghosts of the tangential components read the normal one at Outflow sides: fill that first. stops_backflow:
/// what flows back through an Outflow side brings no momentum. Periodic ghosts that do not count are left
/// out.
void fill_velocity_ghosts(const FaceVector<Real>& velocity, int c, const DomainSides& sides,
                          int width = Layout::ghost_width, bool stops_backflow = false,
                          const GhostAxes& counting = {});

/// Points on high Outflow sides := the points beside them.
void fill_outflow_points(const FaceVector<Real>& velocity, const DomainSides& sides);

/// fill_velocity_ghosts for a change of the velocity: zero on prescribed points, homogeneous ghosts.
void fill_correction_ghosts(const Field<Real>& correction, int c, const DomainSides& sides, int width = 1,
                            const GhostAxes& counting = {});

/// open: faces on sides that the pressure does not see become 0, those on Outflow sides fully open unless the
/// cell behind is solid; beyond, mirrored.
void fill_open_ghosts(const FaceVector<OpenFraction>& open, const Field<Real>& sdf, const DomainSides& sides);

/// Adds the flux per cell volume through the prescribed faces to the divergence of the cells behind them;
/// returns the largest magnitude there.
Real add_side_flux(const Grid& grid, const DomainSides& sides, const Field<Real>& sdf,
                   const Field<Real>& divergence);

/// Flux into the box through the prescribed faces.
Real net_inflow(const Grid& grid, const DomainSides& sides, const Field<Real>& sdf);

}  // namespace peclet::flow
