#pragma once
// All scalars of a flow: owns their fields, and advances them one step as flow/scalar_transport.hpp says.
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "flow/scalar_transport.hpp"
#include "flow/viscous_solver.hpp"

namespace peclet::flow {

/// What the flow hands over.
struct ScalarFlow {
  SolidSampler solid;
  FaceVector<OpenFraction> open;
  FaceVector<Real> carrier;
  CutCells cut_cells;
  DomainSides sides;
  int bodies = 0;
};

/// Buoyancy: the acceleration -expansion (c - reference) gravity.
struct Buoyancy {
  int scalar = -1;  // none
  Real expansion = 0, reference = 0;
  Real3 gravity{0, 0, 0};
};

/// residual += strength (c - reference) at the faces along axis, c the mean of both cells plus ratio times
/// its last change.
void add_buoyant_change(const ScalarFields& fields, int axis, Real strength, Real ratio, Real reference,
                        const RowRanges& rows, const Field<Real>& residual);

struct Scalar {
  std::string name;
  ScalarSettings settings;
  ScalarSides sides;
  ScalarWall wall;                               // of every body but those that follow
  std::vector<std::optional<ScalarWall>> walls;  // per body
  Array<ScalarWall> wall_of_owner;               // the same where kernels run, see ScalarGeometry
  Field<Real> source_field;
  ScalarFields fields;  // predicted and advected are shared between scalars

  ScalarRows rows;
  ExtensionCells extension;
  bool is_conservative = true;  // no wall or side of given value
  bool geometry_stale = true, value_changed = true;
  Real previous_time_step = 0;  // 0: the next step has no past
  SolverReport report;
  std::vector<Real> given;  // amount per time by giver_index, mean over the last step
};

class Scalars {
 public:
  explicit Scalars(const Grid& grid) : grid_(grid) {}

  int count() const { return static_cast<int>(scalars_.size()); }
  /// Index of the scalar of this name, -1 if there is none.
  int find(const std::string& name) const;
  int add(const std::string& name, const ScalarSettings& settings);
  Scalar& operator[](int n) { return scalars_[static_cast<std::size_t>(n)]; }
  const Scalar& operator[](int n) const { return scalars_[static_cast<std::size_t>(n)]; }

  /// body: all bodies where empty.
  void set_wall(int n, const std::optional<int>& body, const ScalarWall& wall);
  void set_buoyancy(const Buoyancy& buoyancy) { buoyancy_ = buoyancy; }
  const Buoyancy& buoyancy() const { return buoyancy_; }

  /// The fields of one scalar have been overwritten from a checkpoint, after prepare().
  void restore_past(int n, Real previous_time_step);

  /// The flow has other walls.
  void geometry_changed();
  /// Brings walls, sides, states and ghosts up to date. Throws if an inflow brings an unknown value.
  void prepare(const ScalarFlow& flow);
  void advance(const ScalarFlow& flow, Real time_step);
  /// Solves for the steady state that the flow as it is leads to.
  void solve_steady(int n, const ScalarFlow& flow);

  bool has_buoyancy() const { return buoyancy_.scalar >= 0; }
  /// residual += dt times the buoyant acceleration along c at the middle of the step.
  void add_buoyancy(int c, Real time_step, const RowRanges& rows, const Field<Real>& residual) const;

  Real amount(int n) const {
    return grid_.cell_volume() * sum_in_fluid((*this)[n].fields, (*this)[n].fields.value);
  }
  Real3 mean_flux(int n, const ScalarFlow& flow) const;
  std::size_t bytes() const;

 private:
  void take_sides(Scalar& scalar, const DomainSides& sides) const;
  ScalarTerms terms(const Scalar& scalar, const ScalarFlow& flow, Real time_step) const;
  void prepare(Scalar& scalar, const ScalarFlow& flow);
  void advance(Scalar& scalar, const ScalarFlow& flow, Real time_step);
  /// Returns what is added to every cell, so that nothing is lost where nothing can be.
  Real solve_diffusion(Scalar& scalar, const ScalarTerms& terms, const Field<Real>& correction);
  void fill(const Scalar& scalar, const Field<Real>& value) const;

  Grid grid_;
  SweepPlan plan_;
  std::deque<Scalar> scalars_;
  Buoyancy buoyancy_;
  Field<Real> predicted_, advected_, residual_, correction_;
  Field<OpenFraction> old_state_;
  Array<Index> scratch_;
  std::optional<ViscousSolver> diffusion_solver_;
  ScatterSum sums_;
};

}  // namespace peclet::flow
