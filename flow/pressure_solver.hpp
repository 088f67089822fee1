#pragma once
// Solver of the pressure equation on open fractions.
#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "core/field.hpp"
#include "core/grid.hpp"
#include "core/halo.hpp"
#include "core/loop.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

struct PressureSettings {
  Real relative_tolerance = 1e-6;  ///< of the 2-norm of the right-hand side
  Real residual_limit =
      std::numeric_limits<Real>::infinity();  ///< bound on the largest residual, must hold too
  int max_iterations = 100;
};

struct SolveReport {
  int iterations = 0;
  Real residual = 0;          ///< 2-norm of the residual recomputed in double precision over that of the rhs
  Real largest_residual = 0;  ///< largest absolute residual, in units of the rhs
  bool converged = false;
};

/// Ghosts of a value at cell centres: periodic copies, mirrored on Closed sides, antisymmetric on Fixed
/// sides. Periodic ghosts that do not count are left out.
void fill_pressure_ghosts(const Field<Real>& pressure, const PressureSides& sides,
                          int width = Layout::ghost_width, const GhostAxes& counting = {});

/// Solves  sum over the faces of a cell of  o (phi_neighbour - phi) / h_a^2 = rhs  in every cell with an open
/// face, o being the open fraction of the face and h_a the spacing normal to it.
class PressureSolver {
 public:
  PressureSolver(const Grid& grid, const PressureSides& sides);
  ~PressureSolver();
  PressureSolver(PressureSolver&&) noexcept;
  PressureSolver& operator=(PressureSolver&&) noexcept;

  /// Keeps a shared reference to the fractions; open.x(i, j, k) belongs to the low x face of cell (i, j, k).
  /// The caller fills the ghosts: periodic copies; on other sides the boundary faces (index 0 and index n,
  /// the latter in the ghost layer) are 0 where Closed and positive where Fixed. Cells outside rows are
  /// solid for good. Derives all levels.
  void set_open_fractions(const FaceVector<OpenFraction>& open, const RowRanges& rows);

  /// The fractions changed, but only on faces of cells in these boxes. A box may reach over periodic sides.
  void update_open_fractions(const std::vector<Box>& changed);

  /// rhs is per unit volume; phi holds the first guess on entry. The mean of rhs over every connected fluid
  /// region that no Fixed side touches is ignored (and removed from rhs if there are several regions).
  /// On return cells without an open face have phi = 0, and the ghosts of phi are filled: periodic copies,
  /// mirrored on Closed sides, antisymmetric on Fixed sides.
  SolveReport solve(const Field<Real>& rhs, const Field<Real>& phi, const PressureSettings& settings);

  /// Memory held, without the open fractions.
  std::size_t bytes() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace peclet::flow
