#pragma once
// Cells in which two bodies meet, or a body and a side of the box that it touches: along an axis the faces
// on both sides are closed, by one of the two each. The fluid in the gap, which the grid does not resolve,
// pushes both apart with the pressure of the fluid around it. Without that, a body beside another would lack
// the pressure on a part of its surface, and its force would depend on the level of the pressure. A body that
// a side cuts feels the pressure on the part that is wetted.
#include "flow/domain_sides.hpp"
#include "flow/near_cells.hpp"
#include "flow/solid_sampler.hpp"

namespace peclet::flow {

/// Contact cells along one axis.
struct ContactCells {
  Index count = 0;
  Array<Index> cell;
  Array<int> low, high;  // bodies that close the low and the high face, or sides of the box

  void reserve(Index capacity);
  Index bytes() const { return static_cast<Index>(cell.extent(0) * (sizeof(Index) + 2 * sizeof(int))); }
};

/// Lists the contact cells along axis c among the cells near walls; scratch has room for all of them.
void build_contact_cells(int c, const SolidSampler& solid, const FaceVector<OpenFraction>& open,
                         const DomainSides& sides, const CellList& near, const Array<Index>& scratch,
                         ContactCells& contacts);

/// Mean over the open cells nearest to this closed one, in cubes of growing size, of
///   p_q + theta mu div F(u*)_q + f . (x - x_q),
/// where f is the gradient at hydrostatic equilibrium. 0 where no open cell is near.
struct SurroundingPressure {
  Grid grid;
  DomainSides sides;
  FaceVector<OpenFraction> open;
  Field<Real> pressure, divergence;
  Real implicit_viscosity;  // theta mu
  Real3 hydrostatic_force;

  KOKKOS_INLINE_FUNCTION Real at(const Int3& cell) const {
    constexpr int farthest = 8;
    for (int reach = 1; reach <= farthest; ++reach) {
      Real sum = 0;
      int count = 0;
      for (int k = -reach; k <= reach; ++k)
        for (int j = -reach; j <= reach; ++j) {
          const bool is_shell = k == -reach || k == reach || j == -reach || j == reach;
          for (int i = -reach; i <= reach; i += is_shell ? 1 : 2 * reach) add({i, j, k}, cell, sum, count);
        }
      if (count > 0) return sum / count;
    }
    return 0;
  }

 private:
  KOKKOS_INLINE_FUNCTION void add(const Int3& step, const Int3& cell, Real& sum, int& count) const {
    int at[3];
    Real rise = 0;
    for (int a = 0; a < 3; ++a) {
      at[a] = cell[a] + step[a];
      rise -= hydrostatic_force[a] * step[a] * grid.spacing[a];
      const int n = grid.cells[a];
      if (at[a] >= 0 && at[a] < n) continue;
      if (!sides.is_periodic(a)) return;
      at[a] = (at[a] % n + n) % n;
    }
    const Index q = pressure.layout()(at[0], at[1], at[2]);
    if (!is_open_cell(open, q)) return;
    sum += pressure[q] + implicit_viscosity * divergence[q] + rise;
    ++count;
  }
};

}  // namespace peclet::flow
