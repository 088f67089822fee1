#pragma once
// Smoothing on one level, fused with the transfer to and from the next coarser one.
//
// Two Jacobi steps whose weights make a Chebyshev polynomial of degree 2 of D^-1 A, D being the diagonal
// [AdamsEtAl2003]. Both sweeps apply the same symmetric polynomial, in any order of the cells.
#include "core/sweep.hpp"
#include "flow/poisson_operator.hpp"

namespace peclet::flow {

/// Inverse roots of the Chebyshev polynomial of degree 2 on [0.4, 1.9]; the spectrum of D^-1 A ends below 2.
inline constexpr float first_weight = 1.614f, second_weight = 0.595f;

/// Unknowns of one level. Everything is zero where there is no open face.
struct LevelFields {
  Field<float> rhs, solution, scratch;
};

/// Connection of a level with the next coarser one.
struct Transfer {
  Merging merging;
  LevelShape coarse_shape;
  RowRanges coarse_rows;        ///< cells of the coarse level
  RowRanges prolongation_rows;  ///< rows of this level, cells of the coarse level along them
};

/// solution = two steps from zero, or from the solution; coarse_rhs = sum of the residual over the children.
template <class Operator>
void smooth_and_restrict(const Operator& op, const SweepPlan& plan, const RowRanges& rows,
                         const Transfer& transfer, const LevelFields& fields, const Field<float>& coarse_rhs,
                         bool from_zero = true);

/// Adds the coarse solution to every child and smooths; returns solution . rhs.
template <class Operator>
Real prolong_and_smooth(const Operator& op, const SweepPlan& plan, const RowRanges& rows,
                        const Transfer& transfer, const LevelFields& fields,
                        const Field<float>& coarse_solution);

/// The same without the transfers: two steps from zero, which leave the residual in fields.scratch, and two
/// steps that return solution . rhs.
template <class Operator>
void smooth_from_zero(const Operator& op, const SweepPlan& plan, const RowRanges& rows,
                      const LevelFields& fields);
template <class Operator>
Real smooth(const Operator& op, const SweepPlan& plan, const RowRanges& rows, const LevelFields& fields);

/// a . b over the rows.
Real dot(const Field<float>& a, const Field<float>& b, const RowRanges& rows, const SweepPlan& plan);

}  // namespace peclet::flow
