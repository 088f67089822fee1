#include "flow/viscous_krylov.hpp"

#include <cmath>

#include "flow/viscous_krylov_stages.hpp"

namespace peclet::flow {

ViscousKrylov::ViscousKrylov(const Layout& layout)
    : shadow_("flow::viscous_shadow", layout),
      search_("flow::viscous_search", layout),
      product_("flow::viscous_product", layout) {}

Real ViscousKrylov::multiply(const ViscousSystem& system, const Field<float>& e, const Field<float>& out,
                             const Field<float>& other) {
  const Diffusion<float> diffusion(system);
  const WallRows &fixed = system.fixed_rows, &moving = system.moving_rows;
  if (system.is_advected()) {
    const UpwindAdvection<float> upwind = system.upwind<float>();
    return sweep("flow::advected_product", *system.plan,
                 Stage(system.rows, RegularProduct{e.layout(), e.data(), out.data(), diffusion},
                       at_walls(fixed, WallProduct{fixed, e, out, diffusion}),
                       at_walls(moving, WallProduct{moving, e, out, diffusion}),
                       AddUpwind<float>{upwind, e.data(), out.data(), 1},
                       at_walls(fixed, AddWallUpwind<float>{fixed, upwind, e, out, 1}),
                       at_walls(moving, AddWallUpwind<float>{moving, upwind, e, out, 1}),
                       MaskedDot{e.layout(), system.open.data(), out.data(), other.data()}))
        .sum;
  }
  return sweep("flow::viscous_product", *system.plan,
               Stage(system.rows, RegularProduct{e.layout(), e.data(), out.data(), diffusion},
                     at_walls(fixed, WallProduct{fixed, e, out, diffusion}),
                     at_walls(moving, WallProduct{moving, e, out, diffusion}),
                     MaskedDot{e.layout(), system.open.data(), out.data(), other.data()}))
      .sum;
}

int ViscousKrylov::solve(const ViscousSystem& system, const ViscousMultigrid& multigrid,
                         const Field<Real>& residual, Real largest, Real reduction, int limit,
                         const Field<float>& e, const Field<float>& r) {
  if (largest == 0) {
    e.fill(0);
    return 0;
  }
  const Layout layout = system.layout();
  const SweepPlan& plan = *system.plan;
  const RowRanges& rows = system.rows;
  const Field<float>&rhs = multigrid.residual(), &direction = multigrid.correction();
  const auto dot_with = [&](const Field<float>& a, const Field<float>& b) { return dot(a, b, rows, plan); };
  const auto advance = [&](const Field<float>& product, Real step) {
    return sweep("flow::viscous_advance", plan,
                 Stage(rows, AdvanceKrylov{layout, direction.data(), product.data(), e.data(), r.data(),
                                           rhs.data(), static_cast<float>(step)}))
        .largest;
  };

  Real rho = sweep("flow::viscous_begin", plan,
                   Stage(rows, BeginKrylov{layout, system.open.data(), residual.data(), e.data(), r.data(),
                                           shadow_.data(), search_.data(), product_.data(), 1 / largest}))
                 .squares;
  Real beta = 0, omega = 0;
  int iterations = 0;
  while (iterations < limit) {
    sweep("flow::viscous_search", plan,
          Stage(rows, NewSearch{layout, r.data(), product_.data(), search_.data(), rhs.data(),
                                static_cast<float>(beta), static_cast<float>(omega)}));
    ++iterations;
    multigrid.apply(system);
    const Real alpha = rho / multiply(system, direction, product_, shadow_);
    if (!std::isfinite(alpha) || alpha == 0 || advance(product_, alpha) <= reduction) break;
    multigrid.apply(system);
    const Real along = multiply(system, direction, rhs, r);
    omega = along / dot_with(rhs, rhs);
    if (!std::isfinite(omega) || omega == 0 || advance(rhs, omega) <= reduction) break;
    const Real next = dot_with(shadow_, r);
    beta = next / rho * (alpha / omega);
    rho = next;
    if (!std::isfinite(beta) || rho == 0) break;
  }
  sweep("flow::viscous_scale", plan,
        Stage(rows, ScaleVector{layout, e.data(), largest}, ghosts_of(system, e)));
  return iterations;
}

std::size_t ViscousKrylov::bytes() const { return 3 * shadow_.array().span() * sizeof(float); }

}  // namespace peclet::flow
