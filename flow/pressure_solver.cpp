#include "flow/pressure_solver.hpp"

#include <cmath>

#include "core/error.hpp"
#include "flow/conjugate_gradient.hpp"
#include "flow/fluid_regions.hpp"

namespace peclet::flow {
namespace {

void require_layout(const Layout& found, const Int3& cells, const std::string& argument) {
  for (int axis = 0; axis < 3; ++axis)
    require(found.cells[axis] == cells[axis], argument,
            std::to_string(cells[axis]) + " cells along axis " + std::to_string(axis), found.cells[axis]);
}

void require_settings(const PressureSettings& settings) {
  require_non_negative(settings.relative_tolerance, "relative_tolerance");
  require(settings.residual_limit >= 0, "residual_limit", "a non-negative number", settings.residual_limit);
  require(settings.max_iterations >= 0, "max_iterations", "a non-negative number", settings.max_iterations);
}

}  // namespace

void fill_pressure_ghosts(const Field<Real>& pressure, const PressureSides& sides, int width,
                          const GhostAxes& counting) {
  for (int axis = 0; axis < 3; ++axis) {
    const Box layers = ghost_layers(pressure.layout().cells, axis, width);
    if (sides.is_periodic(axis)) {
      if (counting.axis[axis]) fill_periodic_layers(pressure, axis, layers);
      continue;
    }
    const Real low = sides.side[axis][0] == PressureSide::Fixed ? -1 : 1;
    const Real high = sides.side[axis][1] == PressureSide::Fixed ? -1 : 1;
    fill_reflected_layers(pressure, axis, layers, low, high);
  }
}

struct PressureSolver::Parts {
  Grid grid;
  PressureSides sides;
  Multigrid multigrid;
  FluidRegions regions;
  Field<unsigned char> group;  ///< of fluid regions, once there were several
  LevelOperator<OpenFraction> physical_operator;
  Field<float> search;
  bool has_operator = false;

  /// Coarse levels for each group of regions.
  void part_regions() {
    const int groups = regions.number_of_groups();
    if (groups > 1 && !group.is_allocated())
      group = Field<unsigned char>("pressure_group", multigrid.finest_operator().shape.layout);
    if (groups > 1)
      multigrid.set_groups(regions.write_groups(group), group);
    else
      multigrid.join_groups();
  }
};

PressureSolver::PressureSolver(const Grid& grid, const PressureSides& sides) : parts_(new Parts) {
  constexpr Index most_cells = std::numeric_limits<int>::max();
  for (int axis = 0; axis < 3; ++axis) {
    require(grid.cells[axis] > 0, "cells", "a positive number along each axis", grid.cells[axis]);
    require_positive(grid.spacing[axis], "spacing");
    const bool low = sides.side[axis][0] == PressureSide::Periodic;
    const bool high = sides.side[axis][1] == PressureSide::Periodic;
    require(low == high, "sides", "both or neither side of axis " + std::to_string(axis) + " periodic",
            low ? "the low one" : "the high one");
  }
  require(grid.number_of_cells() < most_cells, "cells", "fewer than 2^31 in all", grid.number_of_cells());
  parts_->grid = grid;
  parts_->sides = sides;
  parts_->multigrid = Multigrid(grid.cells, grid.spacing, sides);
  const LevelShape shape(grid.cells, sides);
  parts_->regions = FluidRegions(shape);
  parts_->search = Field<float>("pressure_search", shape.layout);
}

PressureSolver::~PressureSolver() = default;
PressureSolver::PressureSolver(PressureSolver&&) noexcept = default;
PressureSolver& PressureSolver::operator=(PressureSolver&&) noexcept = default;

void PressureSolver::set_open_fractions(const FaceVector<OpenFraction>& open, const RowRanges& rows) {
  const Grid& grid = parts_->grid;
  Real3 weights;
  for (int axis = 0; axis < 3; ++axis) {
    require_layout(open[axis].layout(), grid.cells, "open");
    require(rows.box.low[axis] >= 0 && rows.box.high[axis] <= grid.cells[axis] && rows.box.extent(axis) >= 0,
            "rows", "a box inside the grid", rows.box.high[axis]);
    weights[axis] = open_fraction_unit / (grid.spacing[axis] * grid.spacing[axis]);
  }
  parts_->multigrid.set_open_fractions(open, rows);
  parts_->physical_operator =
      LevelOperator<OpenFraction>(parts_->multigrid.finest_operator().shape, open, weights);
  parts_->physical_operator.open_vectors = parts_->multigrid.finest_operator().open_vectors;
  parts_->regions.find(parts_->multigrid.finest_operator());
  parts_->part_regions();
  parts_->search.fill(0);
  parts_->has_operator = true;
}

void PressureSolver::update_open_fractions(const std::vector<Box>& changed) {
  require_state(parts_->has_operator, "update_open_fractions: set_open_fractions has not been called");
  parts_->regions.update(parts_->multigrid.finest_operator(), changed);
  if (parts_->regions.number_of_groups() > 1 || parts_->multigrid.number_of_groups() > 1)
    parts_->part_regions();
  else
    parts_->multigrid.update(changed);
}

SolveReport PressureSolver::solve(const Field<Real>& rhs, const Field<Real>& phi,
                                  const PressureSettings& settings) {
  require_state(parts_->has_operator, "solve: set_open_fractions has not been called");
  require_layout(rhs.layout(), parts_->grid.cells, "rhs");
  require_layout(phi.layout(), parts_->grid.cells, "phi");
  require_settings(settings);
  const Multigrid& multigrid = parts_->multigrid;
  const FluidRegions& regions = parts_->regions;
  const Real cells = static_cast<Real>(regions.number_of_open_cells());

  PressureEquation equation{parts_->physical_operator, rhs, phi, 0};
  if (regions.number_of_regions() > 1) regions.remove_means(rhs);
  Norms norms = measure_rhs(equation, multigrid.rows(), multigrid.plan());
  const Real size = std::sqrt(norms.squares);
  if (regions.number_of_regions() == 1 && !regions.first_is_fixed()) {
    equation.mean = norms.sum / cells;
    norms = measure_rhs(equation, multigrid.rows(), multigrid.plan());
  }
  SolveReport report;
  // What is left of a constant right-hand side is rounding.
  constexpr Real rounding = 1e-14;
  if (norms.squares <= rounding * rounding * size * size) {
    phi.fill(0);
    report.converged = true;
    return report;
  }
  const Real norm = std::sqrt(norms.squares);
  report = conjugate_gradient(equation, multigrid, parts_->search, norm, std::sqrt(cells) / norm, settings);
  // a region that walls cut off keeps the mean pressure that it had
  if (regions.number_of_regions() > 1) regions.remove_means(phi);
  fill_pressure_ghosts(phi, parts_->sides);
  return report;
}

std::size_t PressureSolver::bytes() const {
  return parts_->multigrid.bytes() + parts_->regions.bytes() + parts_->search.array().span() * sizeof(float) +
         parts_->group.array().span();
}

}  // namespace peclet::flow
