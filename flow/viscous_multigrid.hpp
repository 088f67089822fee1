#pragma once
// Cycles of multigrid on a viscous system, from zero.
//
// The finest level is smoothed by sweeps on the operator itself, walls and sides included; those below belong
// to a symmetric relative of it, see viscous_links.hpp. Where advection is implicit, the finest level is
// that of the relative too. Everything runs in single precision.
#include "flow/multigrid.hpp"
#include "flow/viscous_links.hpp"

namespace peclet::flow {

class ViscousMultigrid {
 public:
  ViscousMultigrid(const Grid& grid, const DomainSides& sides);

  /// False after a change of the periodic sides.
  bool fits(const DomainSides& sides) const;
  /// Takes over the coefficients of a system, if they are others than the last ones of its component.
  void set_system(const ViscousSystem& system);
  /// Whether a cycle alone reduces errors of any kind: that of a relative may not.
  bool is_solver(const ViscousSystem& system) const {
    return !system.is_advected() && levels_[0].number_of_levels() > 1;
  }

  /// Right-hand side and result of a cycle.
  const Field<float>& residual() const { return levels_[0].residual(); }
  const Field<float>& correction() const { return levels_[0].correction(); }
  /// correction = M^-1 residual, ghosts filled; what is left in residual() has no meaning.
  void apply(const ViscousSystem& system) const;
  /// The same by one or several cycles for a residual elsewhere, in any precision, where is_solver(system).
  template <class T>
  void apply(const ViscousSystem& system, const Field<T>& residual, int cycles) const;

  Real largest_diagonal(const ViscousSystem& system) const {
    return Diffusion<Real>(system.grid, taken_[system.component].exchange).diagonal;
  }
  std::size_t bytes() const;

 private:
  template <int RatioX, class T>
  void smooth_operator(const ViscousSystem& system, const Field<T>& residual, int cycles) const;
  void smooth_relative(const ViscousSystem& system) const;

  /// What the levels of a component stand for.
  struct Taken {
    Index revision = -1;
    Real diffusion = 0;
    Real exchange = 0;  ///< diffusion that bounds the exchange between neighbours
  };

  PressureSides sides_;
  BasicMultigrid<true> levels_[3];  // of each component; the finest fields are shared
  Taken taken_[3];
  FaceVector<OpenFraction> links_;  // of the component that was taken over last
  Field<float> reaction_;
};

}  // namespace peclet::flow
