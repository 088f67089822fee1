#pragma once
// From signed distances to the discrete geometry: open fractions, wall rows, and what moving bodies impose.
// Fixed bodies are sampled once; an update touches only the cells around moving ones, where they were and
// where they are.
#include "flow/bodies.hpp"
#include "flow/contact_cells.hpp"
#include "flow/domain_sides.hpp"
#include "flow/moving_walls.hpp"
#include "flow/near_cells.hpp"
#include "flow/open_faces.hpp"
#include "flow/region_list.hpp"
#include "flow/settings.hpp"
#include "flow/slits.hpp"
#include "flow/solid_sampler.hpp"
#include "flow/wall_rows.hpp"

namespace peclet::flow {

class ImmersedBoundary {
 public:
  ImmersedBoundary(const Grid& grid, const DomainSides& sides);

  /// Sample everything: fixed bodies and, if allocated, the solid given as distances at cell centres.
  void build(Bodies& bodies, const Field<Real>& samples, const WallFriction& friction);
  /// Re-sample the moving bodies. Before the geometry changes, the pressure of closed cells beside open ones
  /// is extrapolated into them, so that freshly uncovered cells start from it.
  void update(Bodies& bodies, const Field<Real>& pressure, const WallFriction& friction,
              const Real3& hydrostatic_force = {0, 0, 0});
  /// Only the velocities of the bodies changed.
  void refresh_velocity(Bodies& bodies);
  /// Friction follows the mean velocities of the bodies in the step: once these are known.
  void refresh_friction(Bodies& bodies);
  /// The same for closed faces and slits alone, before a geometry update.
  void refresh_face_velocity(Bodies& bodies);

  const FaceVector<OpenFraction>& open() const { return open_; }
  const WallRows& fixed_rows(int c) const { return fixed_rows_[c]; }
  const WallRows& moving_rows(int c) const { return moving_rows_[c]; }
  const Slits& slits(int c) const { return slits_[c]; }
  /// Slits before the last update.
  const Slits& former_slits(int c) const { return former_slits_[c]; }
  const BodyFaces& body_faces(int c) const { return body_faces_[c]; }
  const CutCells& cut_cells() const { return cut_cells_; }
  /// Those of the fixed solid alone; where moving bodies are near, they are among moving_contacts() too.
  const ContactCells& fixed_contacts(int c) const { return fixed_contacts_[c]; }
  const ContactCells& moving_contacts(int c) const { return moving_contacts_[c]; }
  const SolidSampler& solid() const { return solid_; }
  /// Rows of cells that are not solid for good.
  const RowRanges& rows() const { return rows_; }
  const GhostAxes& ghost_axes() const { return ghost_axes_; }
  /// Cells whose faces changed in the last update.
  const std::vector<Box>& changed() const { return changed_; }
  /// Fluid points of component c of the fixed geometry that are none now.
  Real covered_points(int c) const;
  /// Rows and slits beside moving bodies depend on it.
  const WallFriction& friction() const { return friction_; }
  /// A number that no other state of open() and the wall rows has had, of this boundary or another one.
  Index revision() const { return revision_; }
  bool has_slits() const { return slits_[0].count + slits_[1].count + slits_[2].count > 0; }
  bool has_moving_walls() const {
    return moving_rows_[0].count + moving_rows_[1].count + moving_rows_[2].count > 0;
  }
  std::size_t bytes() const;

 private:
  void forget_moving();
  void sample_fixed(Bodies& bodies);
  void sample_moving();
  bool reaches_sides() const;
  void revise();

  Grid grid_;
  DomainSides sides_;
  Index revision_ = 0;
  SolidSampler solid_;
  FaceVector<OpenFraction> open_, fixed_open_;
  Field<Real> fixed_sdf_;
  Field<int> fixed_owner_;
  RowRanges rows_;
  GhostAxes ghost_axes_;
  RegionList regions_;
  CellList band_, former_band_, near_;  // near_ is part of band_
  int band_mark_ = cell_mark::in_even_band;
  bool fixed_is_empty_ = true;
  std::vector<Box> surfaces_, changed_;  // surfaces_: one box per region
  bool reached_sides_ = false;
  Array<Index> scratch_;
  WallFriction friction_;
  WallRows fixed_rows_[3], moving_rows_[3];
  Slits slits_[3], former_slits_[3];
  BodyFaces body_faces_[3];
  CutCells cut_cells_;
  ContactCells fixed_contacts_[3], moving_contacts_[3];
};

}  // namespace peclet::flow
