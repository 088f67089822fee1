#pragma once
// One time step of a scalar. With r = dt / dt_old, extrapolated value v = c + r/2 (c - c_old) and correction
// e:
//   c1 = c - dt A(c) + r g                                g: what diffusion and sources gave in the last step
//   c_a = c - dt/2 (A(c) + A(c1))                         advected [ShuOsher1988]
//   c_new = c + r (c - c_old) + e,  c_new - c_a = dt (D L (v + theta e) + s)
// Pure advection is a convex combination of steps of Euler's method: what a limiter bounds stays bounded.
// Diffusion is that of the momentum predictor (flow/momentum.hpp). Steady states do not depend on dt.
// A(c) = div(F c_f) with the fluxes F of the projection, so that a uniform scalar stays uniform.
#include "core/scatter_sum.hpp"
#include "core/sweep.hpp"
#include "flow/moving_walls.hpp"
#include "flow/scalar_rows.hpp"

namespace peclet::flow {

/// Fields of a scalar, ghosts of value and predicted filled where they are read.
struct ScalarFields {
  Field<Real> value, previous;  // c, c_old
  Field<Real> gain;             // g
  Field<Real> predicted;        // c1
  Field<Real> advected;         // c_a
  Field<OpenFraction> state;
  Field<float> volume;
};

struct ScalarTerms {
  Grid grid;
  ScalarFields fields;
  FaceVector<Real> carrier;  // at the middle of the step, ghosts filled
  FaceVector<OpenFraction> open;
  Field<Real> sdf;
  ScalarSides sides;
  ScalarScheme scheme = ScalarScheme::Koren;
  Real time_step = 1, step_ratio = 0, implicit_weight = 1;
  Real diffusivity = 0, source = 0;
  Field<Real> source_field;  // added to source, if allocated
  Real3 mean_gradient{0, 0, 0};
};

/// predicted = c1. The volume that moving walls sweep out of a cut cell takes the value of the cell along.
void predict_scalar(const ScalarTerms& terms, const SweepPlan& plan, const ScalarRows& rows,
                    const CutCells& cut_cells);

/// advected = c_a, residual = c_a + dt (D L v + s) - (c + r (c - c_old)): what e must balance.
void compute_scalar_residual(const ScalarTerms& terms, const SweepPlan& plan, const ScalarRows& rows,
                             const CutCells& cut_cells, const Field<Real>& residual);

/// previous = c_new = c + r (c - c_old) + e + left_over and gain = c_new - c_a in fluid cells.
void apply_scalar_correction(const ScalarTerms& terms, const SweepPlan& plan, const Field<Real>& correction,
                             Real left_over);

/// Adds what every giver (giver_index) gave to the fluid per time; owner: nearest body of a cell.
void add_wall_exchange(const ScalarTerms& terms, const ScalarRows& rows, const Field<Real>& correction,
                       const Field<int>& owner, int bodies, ScatterSum& sums);

/// Mean over the box of the flux u c - D grad c with the present fields.
Real3 mean_scalar_flux(const ScalarTerms& terms, const ScalarRows& rows);

/// Mean over the fluid, and the largest deviation from it.
struct ScalarSpread {
  Real mean = 0, largest = 0;
};
ScalarSpread scalar_spread(const ScalarFields& fields, const Field<Real>& value);
/// Sum of the fluid part of the cells times value (or of the fluid part alone, without a value).
Real sum_in_fluid(const ScalarFields& fields, const Field<Real>& value);

/// Ghosts: periodic copies; beyond sides, linear through a given value, else mirrored.
void fill_scalar_ghosts(const Field<Real>& value, const ScalarSides& sides);

}  // namespace peclet::flow
