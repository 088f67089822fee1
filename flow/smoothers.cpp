#include "flow/smoothers.hpp"

#include "flow/level_transfer.hpp"

namespace peclet::flow {
namespace {

/// old + weight (target / diagonal - old), or zero in a cell without an open face.
KOKKOS_INLINE_FUNCTION float relaxed(float old, float weight, float target, float diagonal) {
  const float value = weight * target / diagonal + (1 - weight) * old;
  return diagonal > 0 ? value : 0;
}

template <class Operator>
using RowOf = decltype(Operator().template row<float>(0, 0));

/// Jacobi step from zero.
template <class Operator>
struct FirstStep {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Operator op;
  const float* rhs;
  float* out;
  float weight;

  struct Row {
    RowOf<Operator> c;
    const float* rhs;
    float* out;
    float weight;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const {
      out[i] = relaxed(0, weight, rhs[i], c.diagonal(i));
    }
    KOKKOS_INLINE_FUNCTION bool is_plain(int i) const { return c.is_open_vector(i); }
    KOKKOS_INLINE_FUNCTION void plain(int i) const {
      out[i] = relaxed(0, weight, rhs[i], c.open.diagonal(i));
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = op.shape.layout(0, j, k);
    return {op.template row<float>(j, k), rhs + n, out + n, weight};
  }
};

/// out = in + weight D^-1 (rhs - A in); the result is out . rhs if Total.
template <class Operator, class Reduction>
struct JacobiStep {
  using Result = Reduction;
  static constexpr bool may_overrun = true;
  Operator op;
  const float* rhs;
  float* in;
  float* out;
  float weight;

  struct Row {
    RowOf<Operator> c;
    NeighbourRows<float> in;
    const float* rhs;
    float* out;
    float weight;
    template <class Coefficients>
    KOKKOS_INLINE_FUNCTION auto treat(const Coefficients& coefficients, int i) const {
      const float target = rhs[i] + coefficients.neighbours(in, i);
      const float value = relaxed(in.centre[i], weight, target, coefficients.diagonal(i));
      out[i] = value;
      if constexpr (std::is_same_v<Reduction, Total>) return value * rhs[i];
    }
    KOKKOS_INLINE_FUNCTION auto operator()(int i) const { return treat(c, i); }
    KOKKOS_INLINE_FUNCTION bool is_plain(int i) const { return c.is_open_vector(i); }
    KOKKOS_INLINE_FUNCTION auto plain(int i) const { return treat(c.open, i); }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = op.shape.layout(0, j, k);
    return {op.template row<float>(j, k), neighbour_rows(op.shape, in, j, k), rhs + n, out + n, weight};
  }
};

/// out = rhs - A in.
template <class Operator>
struct Residual {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Operator op;
  const float* rhs;
  float* in;
  float* out;

  struct Row {
    RowOf<Operator> c;
    NeighbourRows<float> in;
    const float* rhs;
    float* out;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const { out[i] = rhs[i] + c.laplacian(in, i); }
    KOKKOS_INLINE_FUNCTION bool is_plain(int i) const { return c.is_open_vector(i); }
    KOKKOS_INLINE_FUNCTION void plain(int i) const { out[i] = rhs[i] + c.open.laplacian(in, i); }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = op.shape.layout(0, j, k);
    return {op.template row<float>(j, k), neighbour_rows(op.shape, in, j, k), rhs + n, out + n};
  }
};

struct Product {
  using Result = Total;
  static constexpr bool may_overrun = true;
  Layout layout;
  const float *a, *b;

  struct Row {
    const float *a, *b;
    KOKKOS_INLINE_FUNCTION float operator()(int i) const { return a[i] * b[i]; }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {a + n, b + n};
  }
};

template <int RatioX, class Operator>
void smooth_and_restrict_by(const Operator& op, const SweepPlan& plan, const RowRanges& rows,
                            const Transfer& transfer, const LevelFields& fields,
                            const Field<float>& coarse_rhs, bool from_zero) {
  const float* const rhs = fields.rhs.array().data();
  float* const solution = fields.solution.array().data();
  float* const scratch = fields.scratch.array().data();
  const auto after = [&](const auto& first) {
    sweep("flow::smooth", plan, first,
          Stage{rows, JacobiStep<Operator, Nothing>{op, rhs, scratch, solution, second_weight}},
          CoarseningStage{Stage{rows, Residual<Operator>{op, rhs, solution, scratch}},
                          Stage{transfer.coarse_rows,
                                SumOfChildren<RatioX>{op.shape, transfer.coarse_shape, transfer.merging,
                                                      scratch, coarse_rhs.array().data()}},
                          transfer.merging.ratio, transfer.merging.shift});
  };
  if (from_zero)
    after(Stage{rows, FirstStep<Operator>{op, rhs, scratch, first_weight}});
  else
    after(Stage{rows, JacobiStep<Operator, Nothing>{op, rhs, solution, scratch, first_weight}});
}

template <int RatioX, class Operator>
Real prolong_and_smooth_by(const Operator& op, const SweepPlan& plan, const RowRanges& rows,
                           const Transfer& transfer, const LevelFields& fields,
                           const Field<float>& coarse_solution) {
  const float* const rhs = fields.rhs.array().data();
  float* const solution = fields.solution.array().data();
  float* const scratch = fields.scratch.array().data();
  return sweep("flow::smooth", plan,
               Stage{transfer.prolongation_rows,
                     AddToChildren<RatioX>{op.shape, transfer.coarse_shape, transfer.merging,
                                           coarse_solution.array().data(), solution}},
               Stage{rows, JacobiStep<Operator, Nothing>{op, rhs, solution, scratch, first_weight}},
               Stage{rows, JacobiStep<Operator, Total>{op, rhs, scratch, solution, second_weight}})
      .sum;
}

}  // namespace

template <class Operator>
void smooth_and_restrict(const Operator& op, const SweepPlan& plan, const RowRanges& rows,
                         const Transfer& transfer, const LevelFields& fields, const Field<float>& coarse_rhs,
                         bool from_zero) {
  if (transfer.merging.ratio[0] == 2)
    smooth_and_restrict_by<2>(op, plan, rows, transfer, fields, coarse_rhs, from_zero);
  else
    smooth_and_restrict_by<1>(op, plan, rows, transfer, fields, coarse_rhs, from_zero);
}

template <class Operator>
Real prolong_and_smooth(const Operator& op, const SweepPlan& plan, const RowRanges& rows,
                        const Transfer& transfer, const LevelFields& fields,
                        const Field<float>& coarse_solution) {
  if (transfer.merging.ratio[0] == 2)
    return prolong_and_smooth_by<2>(op, plan, rows, transfer, fields, coarse_solution);
  return prolong_and_smooth_by<1>(op, plan, rows, transfer, fields, coarse_solution);
}

template <class Operator>
void smooth_from_zero(const Operator& op, const SweepPlan& plan, const RowRanges& rows,
                      const LevelFields& fields) {
  const float* const rhs = fields.rhs.array().data();
  float* const solution = fields.solution.array().data();
  float* const scratch = fields.scratch.array().data();
  sweep("flow::smooth", plan, Stage{rows, FirstStep<Operator>{op, rhs, scratch, first_weight}},
        Stage{rows, JacobiStep<Operator, Nothing>{op, rhs, scratch, solution, second_weight}},
        Stage{rows, Residual<Operator>{op, rhs, solution, scratch}});
}

template <class Operator>
Real smooth(const Operator& op, const SweepPlan& plan, const RowRanges& rows, const LevelFields& fields) {
  const float* const rhs = fields.rhs.array().data();
  float* const solution = fields.solution.array().data();
  float* const scratch = fields.scratch.array().data();
  return sweep("flow::smooth", plan,
               Stage{rows, JacobiStep<Operator, Nothing>{op, rhs, solution, scratch, first_weight}},
               Stage{rows, JacobiStep<Operator, Total>{op, rhs, scratch, solution, second_weight}})
      .sum;
}

Real dot(const Field<float>& a, const Field<float>& b, const RowRanges& rows, const SweepPlan& plan) {
  return sweep("flow::dot", plan, Stage{rows, Product{a.layout(), a.array().data(), b.array().data()}}).sum;
}

template void smooth_and_restrict(const LevelOperator<OpenFraction>&, const SweepPlan&, const RowRanges&,
                                  const Transfer&, const LevelFields&, const Field<float>&, bool);
template Real prolong_and_smooth(const LevelOperator<OpenFraction>&, const SweepPlan&, const RowRanges&,
                                 const Transfer&, const LevelFields&, const Field<float>&);
template void smooth_and_restrict(const LevelOperator<float>&, const SweepPlan&, const RowRanges&,
                                  const Transfer&, const LevelFields&, const Field<float>&, bool);
template Real prolong_and_smooth(const LevelOperator<float>&, const SweepPlan&, const RowRanges&,
                                 const Transfer&, const LevelFields&, const Field<float>&);
template void smooth_and_restrict(const ReactiveOperator<OpenFraction>&, const SweepPlan&, const RowRanges&,
                                  const Transfer&, const LevelFields&, const Field<float>&, bool);
template Real prolong_and_smooth(const ReactiveOperator<OpenFraction>&, const SweepPlan&, const RowRanges&,
                                 const Transfer&, const LevelFields&, const Field<float>&);
template void smooth_and_restrict(const ReactiveOperator<float>&, const SweepPlan&, const RowRanges&,
                                  const Transfer&, const LevelFields&, const Field<float>&, bool);
template Real prolong_and_smooth(const ReactiveOperator<float>&, const SweepPlan&, const RowRanges&,
                                 const Transfer&, const LevelFields&, const Field<float>&);

template void smooth_from_zero(const LevelOperator<OpenFraction>&, const SweepPlan&, const RowRanges&,
                               const LevelFields&);
template Real smooth(const LevelOperator<OpenFraction>&, const SweepPlan&, const RowRanges&,
                     const LevelFields&);

}  // namespace peclet::flow
