#include "flow/conjugate_gradient.hpp"

#include <cmath>
#include <limits>

namespace peclet::flow {
namespace {

struct RhsInFluid {
  using Result = Norms;
  static constexpr bool may_overrun = true;
  LevelOperator<OpenFraction> op;
  const Real* rhs;
  Real mean;

  struct Row {
    CoefficientRow<OpenFraction, Real> c;
    const Real* rhs;
    Real mean;
    KOKKOS_INLINE_FUNCTION Real operator()(int i) const { return c.is_open(i) ? rhs[i] - mean : 0; }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    return {op.row<Real>(j, k), rhs + op.shape.layout(0, j, k), mean};
  }
};

/// Residual L phi - (rhs - mean), also stored as residual * scale; phi becomes zero in closed cells.
struct TrueResidual {
  using Result = Norms;
  static constexpr bool may_overrun = false;
  LevelOperator<OpenFraction> op;
  const Real* rhs;
  Real* phi;
  float* residual;
  Real mean, scale;

  struct Row {
    CoefficientRow<OpenFraction, Real> c;
    NeighbourRows<Real> phi;
    const Real* rhs;
    float* residual;
    Real mean, scale;
    KOKKOS_INLINE_FUNCTION Real operator()(int i) const {
      const bool open = c.is_open(i);
      const Real r = open ? c.laplacian(phi, i) - (rhs[i] - mean) : 0;
      residual[i] = static_cast<float>(r * scale);
      if (!open) phi.centre[i] = 0;
      return r;
    }
    KOKKOS_INLINE_FUNCTION bool is_plain(int i) const { return c.is_open_vector(i); }
    KOKKOS_INLINE_FUNCTION Real plain(int i) const {
      const Real r = c.open.laplacian(phi, i) - (rhs[i] - mean);
      residual[i] = static_cast<float>(r * scale);
      return r;
    }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = op.shape.layout(0, j, k);
    return {op.row<Real>(j, k), neighbour_rows(op.shape, phi, j, k), rhs + n, residual + n, mean, scale};
  }
};

/// search = correction + beta search
struct NewSearchDirection {
  using Result = Nothing;
  static constexpr bool may_overrun = true;
  Layout layout;
  const float* correction;
  float* search;
  float beta;

  struct Row {
    const float* correction;
    float* search;
    float beta;
    KOKKOS_INLINE_FUNCTION void operator()(int i) const { search[i] = correction[i] + beta * search[i]; }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = layout(0, j, k);
    return {correction + n, search + n, beta};
  }
};

/// search . A search
struct Energy {
  using Result = Total;
  static constexpr bool may_overrun = true;
  LevelOperator<OpenFraction> op;
  float* search;

  struct Row {
    CoefficientRow<OpenFraction, float> c;
    NeighbourRows<float> search;
    KOKKOS_INLINE_FUNCTION float operator()(int i) const { return c.energy(search, i); }
    KOKKOS_INLINE_FUNCTION bool is_plain(int i) const { return c.is_open_vector(i); }
    KOKKOS_INLINE_FUNCTION float plain(int i) const { return c.open.energy(search, i); }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    return {op.row<float>(j, k), neighbour_rows(op.shape, search, j, k)};
  }
};

/// phi += phi_step search, residual -= step A search
struct Advance {
  using Result = Norms;
  static constexpr bool may_overrun = true;
  LevelOperator<OpenFraction> op;
  float* search;
  float* residual;
  Real* phi;
  float step;
  Real phi_step;

  struct Row {
    CoefficientRow<OpenFraction, float> c;
    NeighbourRows<float> search;
    float* residual;
    Real* phi;
    float step;
    Real phi_step;
    template <class Coefficients>
    KOKKOS_INLINE_FUNCTION float treat(const Coefficients& coefficients, int i) const {
      const float r = residual[i] + step * coefficients.laplacian(search, i);
      residual[i] = r;
      phi[i] += phi_step * static_cast<Real>(search.centre[i]);
      return r;
    }
    KOKKOS_INLINE_FUNCTION float operator()(int i) const { return treat(c, i); }
    KOKKOS_INLINE_FUNCTION bool is_plain(int i) const { return c.is_open_vector(i); }
    KOKKOS_INLINE_FUNCTION float plain(int i) const { return treat(c.open, i); }
  };
  KOKKOS_INLINE_FUNCTION Row row(int j, int k) const {
    const Index n = op.shape.layout(0, j, k);
    return {
        op.row<float>(j, k), neighbour_rows(op.shape, search, j, k), residual + n, phi + n, step, phi_step};
  }
};

/// The vectors of one solve. Single precision holds  residual * scale  and corrections of phi in units that
/// make A, in units of the smallest spacing, map one to the other.
class Iteration {
 public:
  Iteration(const PressureEquation& equation, const Multigrid& multigrid, const Field<float>& search,
            Real scale)
      : equation_(equation), multigrid_(multigrid), search_(search), scale_(scale) {}

  /// Norms of the residual of phi, which replaces the one carried along.
  Norms recompute_residual() const {
    return sweep("flow::residual", multigrid_.plan(),
                 Stage{multigrid_.rows(),
                       TrueResidual{equation_.op, equation_.rhs.array().data(), equation_.phi.array().data(),
                                    multigrid_.residual().array().data(), equation_.mean, scale_}});
  }
  void forget_search() { product_ = 0; }

  /// One step; the norms of the residual carried along, not finite if the step failed.
  Norms advance() {
    const LevelOperator<OpenFraction>& op = multigrid_.finest_operator();
    const SweepPlan& plan = multigrid_.plan();
    const RowRanges& rows = multigrid_.rows();
    float* const search = search_.array().data();
    const Real product = multigrid_.apply();
    const Real beta = product_ > 0 ? product / product_ : 0;
    const Real energy =
        sweep("flow::search", plan,
              Stage{rows, NewSearchDirection{op.shape.layout, multigrid_.correction().array().data(), search,
                                             static_cast<float>(beta)}},
              Stage{rows, Energy{op, search}})
            .sum;
    product_ = product;
    constexpr Real failed = std::numeric_limits<Real>::quiet_NaN();
    if (!(product > 0) || !(energy > 0) || !std::isfinite(product / energy)) return {failed, failed, failed};
    const Real step = product / energy;
    Norms norms = sweep("flow::advance", plan,
                        Stage{rows, Advance{op, search, multigrid_.residual().array().data(),
                                            equation_.phi.array().data(), static_cast<float>(step),
                                            static_cast<float>(step) / (scale_ * multigrid_.stiffness())}});
    norms.squares /= scale_ * scale_;
    norms.largest /= scale_;
    return norms;
  }

 private:
  const PressureEquation& equation_;
  const Multigrid& multigrid_;
  const Field<float>& search_;
  Real scale_;
  Real product_ = 0;
};

}  // namespace

Norms measure_rhs(const PressureEquation& equation, const RowRanges& rows, const SweepPlan& plan) {
  return sweep("flow::measure_rhs", plan,
               Stage{rows, RhsInFluid{equation.op, equation.rhs.array().data(), equation.mean}});
}

SolveReport conjugate_gradient(const PressureEquation& equation, const Multigrid& multigrid,
                               const Field<float>& search, Real rhs_norm, Real scale,
                               const PressureSettings& settings) {
  // Single precision loses contact with the true residual after about six decades.
  constexpr Real trusted_reduction = 1e-5;
  const Real tolerance = settings.relative_tolerance * rhs_norm;
  Iteration iteration(equation, multigrid, search, scale);
  SolveReport report;
  const auto recompute = [&] {
    const Norms norms = iteration.recompute_residual();
    report.residual = std::sqrt(norms.squares) / rhs_norm;
    report.largest_residual = norms.largest;
    report.converged =
        report.residual <= settings.relative_tolerance && norms.largest <= settings.residual_limit;
    return std::sqrt(norms.squares);
  };

  Real known = recompute();
  Real peak = known;  // since the residual was last recomputed: what single precision loses is a part of it
  int setbacks = 0;
  while (!report.converged && report.iterations < settings.max_iterations && std::isfinite(known)) {
    const Norms norms = iteration.advance();
    const bool failed = !std::isfinite(norms.squares);
    if (!failed) ++report.iterations;
    const Real carried = std::sqrt(norms.squares);
    if (carried > peak) peak = carried;
    const bool seems_converged = carried <= tolerance && norms.largest <= settings.residual_limit;
    if (!failed && !seems_converged && carried > trusted_reduction * peak &&
        report.iterations < settings.max_iterations)
      continue;
    const Real before = known;
    known = peak = recompute();
    if (failed || known > 2 * carried) iteration.forget_search();
    if (known > 0.5 * before && ++setbacks == 2) break;
  }
  return report;
}

}  // namespace peclet::flow
