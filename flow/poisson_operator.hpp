#pragma once
// The operator of the pressure equation on one level of the multigrid hierarchy, row by row.
//
//   (A phi)_cell = sum over its faces of  c_face (phi_cell - phi_neighbour)
//
// c is the face area times the open fraction over the distance of the cell centres, in units in which a
// finest cell has volume 1 and the smallest spacing is 1. Beyond a side the neighbour is the cell across
// (Periodic), the cell itself (Closed) or minus the cell itself (Fixed).
#include <type_traits>

#include "core/box_list.hpp"
#include "core/field.hpp"
#include "core/loop.hpp"
#include "flow/open_fraction.hpp"

namespace peclet::flow {

/// How the cells of a level merge into those of the next coarser one. Along an axis with ratio 2 and shift s,
/// coarse cell I has the children 2 I - s and 2 I - s + 1, as far as they exist: of an odd number of cells
/// the last one (s = 0) or the first one (s = 1) stays alone.
struct Merging {
  Int3 ratio{1, 1, 1}, shift{0, 0, 0};  ///< ratio is 1 or 2

  KOKKOS_INLINE_FUNCTION int first_child(int axis, int cell) const {
    const int child = ratio[axis] * cell - shift[axis];
    return child > 0 ? child : 0;
  }
  /// One past the last child, if there were no end of the row.
  KOKKOS_INLINE_FUNCTION int end_of_children(int axis, int cell) const {
    return ratio[axis] * (cell + 1) - shift[axis];
  }
  /// The children of a coarse cell among this many cells.
  KOKKOS_INLINE_FUNCTION Box children(const Int3& cell, const Int3& cells) const {
    Box box;
    for (int axis = 0; axis < 3; ++axis) {
      const int end = end_of_children(axis, cell[axis]);
      box.low[axis] = first_child(axis, cell[axis]);
      box.high[axis] = end < cells[axis] ? end : cells[axis];
    }
    return box;
  }
  KOKKOS_INLINE_FUNCTION int parent(int axis, int cell) const {
    return (cell + shift[axis]) >> (ratio[axis] - 1);
  }
  /// One past the last parent of the cells before this one.
  KOKKOS_INLINE_FUNCTION int end_of_parents(int axis, int cell) const {
    return (cell + shift[axis] + ratio[axis] - 1) >> (ratio[axis] - 1);
  }
};

/// Cells of one level. Along axis a, cell I covers the finest cells from I factor[a] - offset[a] to
/// (I + 1) factor[a] - offset[a] - 1, as far as they exist: the first and the last cell may be smaller.
struct LevelShape {
  Int3 cells{1, 1, 1};
  Int3 finest_cells{1, 1, 1};
  Int3 factor{1, 1, 1}, offset{0, 0, 0};
  Layout layout;
  PressureSides sides;

  LevelShape() = default;
  LevelShape(const Int3& finest, const PressureSides& box_sides)
      : cells(finest), finest_cells(finest), layout(finest), sides(box_sides) {}
  LevelShape(const LevelShape& finer, const Merging& merging) : LevelShape(finer) {
    for (int axis = 0; axis < 3; ++axis) {
      cells[axis] = merging.end_of_parents(axis, finer.cells[axis]);
      offset[axis] += merging.shift[axis] * factor[axis];
      factor[axis] *= merging.ratio[axis];
    }
    layout = Layout(cells);
  }
  Index number_of_cells() const { return static_cast<Index>(cells[0]) * cells[1] * cells[2]; }
  /// The only cell along a periodic axis is its own neighbour: no exchange along that axis.
  KOKKOS_INLINE_FUNCTION bool is_collapsed(int axis) const {
    return cells[axis] == 1 && sides.is_periodic(axis);
  }
  /// Width of a cell along axis in finest cells.
  KOKKOS_INLINE_FUNCTION int width(int axis, int cell) const {
    const int begin = cell * factor[axis] - offset[axis], end = begin + factor[axis];
    return (end < finest_cells[axis] ? end : finest_cells[axis]) - (begin > 0 ? begin : 0);
  }
  /// Twice the distance of the two cell centres beside a face, in finest cells.
  KOKKOS_INLINE_FUNCTION int twice_distance(int axis, int face) const {
    const int n = cells[axis];
    const bool at_side = face == 0 || face == n;
    if (!at_side) return width(axis, face - 1) + width(axis, face);
    if (sides.is_periodic(axis)) return width(axis, n - 1) + width(axis, 0);
    return 2 * width(axis, face == 0 ? 0 : n - 1);
  }
};

/// The row beside another one, to be multiplied by sign.
template <class T>
struct SideRow {
  T* row;
  T sign;
  KOKKOS_INLINE_FUNCTION T operator()(int i) const { return runs_on_host ? row[i] : sign * row[i]; }
};

/// A row of cells and the four rows beside it. On the host the values beyond the ends of the row and beyond
/// Fixed sides are put into ghost cells that no other row reads; on a device they are selected.
template <class T>
struct NeighbourRows {
  T* centre;
  SideRow<T> south, north, below, above;
  int n, west_source, east_source;
  T west_sign, east_sign;

  KOKKOS_INLINE_FUNCTION T west(int i) const {
    if (runs_on_host) return centre[i - 1];
    return i > 0 ? centre[i - 1] : west_sign * centre[west_source];
  }
  KOKKOS_INLINE_FUNCTION T east(int i) const {
    if (runs_on_host) return centre[i + 1];
    return i < n - 1 ? centre[i + 1] : east_sign * centre[east_source];
  }
};

/// Ghost row beyond a Fixed side.
template <class T>
void fill_ghost_row(const T* row, T* ghost, int n) {
  for (int i = 0; i < n; ++i) ghost[i] = -row[i];
}

template <class T>
KOKKOS_FORCEINLINE_FUNCTION SideRow<T> row_beside(const LevelShape& shape, T* centre, int axis, int index,
                                                  int high) {
  const Index step = high ? shape.layout.stride(axis) : -shape.layout.stride(axis);
  if (index != (high ? shape.cells[axis] - 1 : 0)) return {centre + step, T(1)};
  const PressureSide side = shape.sides.side[axis][high];
  if (side == PressureSide::Periodic) return {centre - (shape.cells[axis] - 1) * step, T(1)};
  if (side == PressureSide::Closed) return {centre, T(1)};
  KOKKOS_IF_ON_DEVICE((return {centre, T(-1)};))
  KOKKOS_IF_ON_HOST((fill_ghost_row(centre, centre + step, shape.cells[0]); return {centre + step, T(1)};))
}

template <class T>
KOKKOS_FORCEINLINE_FUNCTION NeighbourRows<T> neighbour_rows(const LevelShape& shape, T* field, int j, int k) {
  const int n = shape.cells[0];
  T* const centre = field + shape.layout(0, j, k);
  const bool periodic = shape.sides.is_periodic(0);
  const bool low_fixed = shape.sides.side[0][0] == PressureSide::Fixed;
  const bool high_fixed = shape.sides.side[0][1] == PressureSide::Fixed;
  NeighbourRows<T> rows{centre,
                        row_beside(shape, centre, 1, j, 0),
                        row_beside(shape, centre, 1, j, 1),
                        row_beside(shape, centre, 2, k, 0),
                        row_beside(shape, centre, 2, k, 1),
                        n,
                        periodic ? n - 1 : 0,
                        periodic ? 0 : n - 1,
                        low_fixed ? T(-1) : T(1),
                        high_fixed ? T(-1) : T(1)};
  if (runs_on_host) {
    centre[-1] = rows.west_sign * centre[rows.west_source];
    centre[n] = rows.east_sign * centre[rows.east_source];
  }
  return rows;
}

/// Coefficients of cells whose faces are all open. The functions are those of CoefficientRow and round like
/// them.
template <class T>
struct OpenCoefficients {
  T x, y, z;

  KOKKOS_INLINE_FUNCTION T diagonal(int) const { return 2 * x + 2 * y + 2 * z; }
  KOKKOS_INLINE_FUNCTION T neighbours(const NeighbourRows<T>& phi, int i) const {
    return x * (phi.west(i) + phi.east(i)) + y * (phi.south(i) + phi.north(i)) +
           z * (phi.below(i) + phi.above(i));
  }
  KOKKOS_INLINE_FUNCTION T laplacian(const NeighbourRows<T>& phi, int i) const {
    const T c = phi.centre[i];
    return x * ((phi.east(i) - c) - (c - phi.west(i))) + y * ((phi.north(i) - c) - (c - phi.south(i))) +
           z * ((phi.above(i) - c) - (c - phi.below(i)));
  }
  KOKKOS_INLINE_FUNCTION T energy(const NeighbourRows<T>& phi, int i) const {
    const T c = phi.centre[i];
    const T w = c - phi.west(i), e = c - phi.east(i), s = c - phi.south(i), n = c - phi.north(i),
            b = c - phi.below(i), a = c - phi.above(i);
    return T(0.5) * (x * (w * w + e * e) + y * (s * s + n * n) + z * (b * b + a * a));
  }
};

/// Coefficients of the six faces of the cells of a row, in arithmetic T.
template <class Coefficient, class T>
struct CoefficientRow {
  const Coefficient *x, *south, *north, *below, *above;
  T weight_x, weight_y, weight_z;
  Coefficient used_x, used_y, used_z;  ///< all bits of an integer where the weight is not zero
  const unsigned char* open_vectors;   ///< of the row; none on a device
  OpenCoefficients<T> open;

  /// Whether all faces of the cells of the vector that begins at i, a multiple of its length, are open, so
  /// that `open` is theirs.
  KOKKOS_INLINE_FUNCTION bool is_open_vector(int i) const {
    if constexpr (std::is_integral_v<Coefficient>)
      return open_vectors && open_vectors[i / Layout::alignment];
    else
      return false;
  }

  /// Sum of the six coefficients; 0 for a cell without an open face, and only there.
  KOKKOS_INLINE_FUNCTION T diagonal(int i) const {
    return weight_x * (value(x[i]) + value(x[i + 1])) + weight_y * (value(south[i]) + value(north[i])) +
           weight_z * (value(below[i]) + value(above[i]));
  }
  /// Whether the cell has an open face, for integer coefficients.
  KOKKOS_INLINE_FUNCTION bool is_open(int i) const {
    return ((x[i] | x[i + 1]) & used_x) | ((south[i] | north[i]) & used_y) | ((below[i] | above[i]) & used_z);
  }
  /// Sum of coefficient times neighbour.
  KOKKOS_INLINE_FUNCTION T neighbours(const NeighbourRows<T>& phi, int i) const {
    return weight_x * (value(x[i]) * phi.west(i) + value(x[i + 1]) * phi.east(i)) +
           weight_y * (value(south[i]) * phi.south(i) + value(north[i]) * phi.north(i)) +
           weight_z * (value(below[i]) * phi.below(i) + value(above[i]) * phi.above(i));
  }
  /// -(A phi), from differences: exact to the rounding of the second difference where faces are open.
  KOKKOS_INLINE_FUNCTION T laplacian(const NeighbourRows<T>& phi, int i) const {
    const T c = phi.centre[i];
    return weight_x * (value(x[i + 1]) * (phi.east(i) - c) - value(x[i]) * (c - phi.west(i))) +
           weight_y * (value(north[i]) * (phi.north(i) - c) - value(south[i]) * (c - phi.south(i))) +
           weight_z * (value(above[i]) * (phi.above(i) - c) - value(below[i]) * (c - phi.below(i)));
  }
  /// Half the sum of coefficient times squared difference; its sum over all cells is phi . A phi.
  KOKKOS_INLINE_FUNCTION T energy(const NeighbourRows<T>& phi, int i) const {
    const T c = phi.centre[i];
    const T w = c - phi.west(i), e = c - phi.east(i), s = c - phi.south(i), n = c - phi.north(i),
            b = c - phi.below(i), a = c - phi.above(i);
    return T(0.5) * (weight_x * (value(x[i]) * w * w + value(x[i + 1]) * e * e) +
                     weight_y * (value(south[i]) * s * s + value(north[i]) * n * n) +
                     weight_z * (value(below[i]) * b * b + value(above[i]) * a * a));
  }

 private:
  KOKKOS_INLINE_FUNCTION static T value(Coefficient c) {
    if constexpr (std::is_integral_v<Coefficient>) return static_cast<T>(static_cast<int>(c));
    return static_cast<T>(c);
  }
};

/// The operator of one level. Coefficients are stored like open fractions; c = weight * coefficient.
template <class Coefficient>
struct LevelOperator {
  LevelShape shape;
  const Coefficient *x = nullptr, *y = nullptr, *z = nullptr;
  Real weight[3] = {1, 1, 1};
  const unsigned char* open_vectors = nullptr;  ///< set by mark_open_vectors; may be missing

  LevelOperator() = default;
  LevelOperator(const LevelShape& level, const FaceVector<Coefficient>& faces, const Real3& weights)
      : shape(level), x(faces.x.array().data()), y(faces.y.array().data()), z(faces.z.array().data()) {
    for (int axis = 0; axis < 3; ++axis) weight[axis] = level.is_collapsed(axis) ? 0 : weights[axis];
  }

  template <class T>
  KOKKOS_FORCEINLINE_FUNCTION CoefficientRow<Coefficient, T> row(int j, int k) const {
    const Index n = shape.layout(0, j, k);
    const T wx = static_cast<T>(weight[0]), wy = static_cast<T>(weight[1]), wz = static_cast<T>(weight[2]);
    constexpr T whole = fully_open;
    return {x + n,
            y + n,
            y + n + shape.layout.pitch_y,
            z + n,
            z + n + shape.layout.pitch_z,
            wx,
            wy,
            wz,
            used(0),
            used(1),
            used(2),
            open_vectors ? open_vectors + n / Layout::alignment : nullptr,
            {whole * wx, whole * wy, whole * wz}};
  }
  KOKKOS_INLINE_FUNCTION Coefficient used(int axis) const {
    return static_cast<Coefficient>(weight[axis] > 0 ? -1 : 0);
  }
  /// Stored coefficient of a face from the linear indices of the face and of a cell beside it.
  KOKKOS_INLINE_FUNCTION Real coefficient(int axis, Index face, Index) const {
    return static_cast<Real>(axis == 0 ? x[face] : (axis == 1 ? y[face] : z[face]));
  }
  /// Coefficient of the face low of cell (i, j, k), or of the face of index n beyond the last cell.
  KOKKOS_INLINE_FUNCTION Real face(int axis, int i, int j, int k) const {
    const Index n = shape.layout(i, j, k);
    return weight[axis] * static_cast<Real>(axis == 0 ? x[n] : (axis == 1 ? y[n] : z[n]));
  }
};

/// A row of the operator plus a reaction: (A phi)_cell + reaction_cell phi_cell.
template <class Coefficient, class T>
struct ReactiveRow : CoefficientRow<Coefficient, T> {
  const float* reaction;

  KOKKOS_INLINE_FUNCTION static bool is_open_vector(int) { return false; }
  KOKKOS_INLINE_FUNCTION T diagonal(int i) const {
    return CoefficientRow<Coefficient, T>::diagonal(i) + reaction[i];
  }
  KOKKOS_INLINE_FUNCTION T laplacian(const NeighbourRows<T>& phi, int i) const {
    return CoefficientRow<Coefficient, T>::laplacian(phi, i) - reaction[i] * phi.centre[i];
  }
};

/// The operator of one level plus a reaction, which is positive in cells that count and zero elsewhere.
template <class Coefficient>
struct ReactiveOperator : LevelOperator<Coefficient> {
  const float* reaction = nullptr;

  ReactiveOperator() = default;
  ReactiveOperator(const LevelShape& level, const FaceVector<Coefficient>& faces, const Real3& weights,
                   const Field<float>& field)
      : LevelOperator<Coefficient>(level, faces, weights), reaction(field.data()) {}

  template <class T>
  KOKKOS_INLINE_FUNCTION ReactiveRow<Coefficient, T> row(int j, int k) const {
    return {LevelOperator<Coefficient>::template row<T>(j, k), reaction + this->shape.layout(0, j, k)};
  }
};

/// Rows of a level: they cover the rows of the children, and begin and end on whole vectors where they can.
RowRanges coarse_rows(const RowRanges& fine, const LevelShape& coarse, const Merging& merging);
/// The same rows, widened to whole vectors.
RowRanges aligned_rows(const RowRanges& rows, const LevelShape& shape);

/// Coarse coefficients: the sum of the finest open areas over the face, over the distance of the coarse
/// centres; on the faces of the cells of the boxes.
template <class Operator>
void derive_coefficients(const Operator& fine, const LevelShape& coarse, const Merging& merging,
                         const BoxList& boxes, const FaceVector<float>& coefficients);

/// Marks the vectors of cells whose faces are all open. The boxes count vectors along x, cells along y and z.
void mark_open_vectors(const LevelOperator<OpenFraction>& op, const BoxList& boxes,
                       const Array<unsigned char>& open_vectors);

/// The reaction on a level. mass: its part that is no exchange with walls; without a field, at most
/// cell_mass everywhere. from_coarse_centres: whether the exchange with walls is that of the coarse cells.
struct Reaction {
  LevelShape shape;
  Field<float> total, mass;
  float cell_mass = 0;
  bool from_coarse_centres = false;
};

/// Coarse reaction of the cells of the boxes: the mass of the children and their exchange with walls, or, as
/// the walls are further away from coarse centres, a share of it: half where cells merge along all axes.
void derive_reaction(const Reaction& fine, const Merging& merging, const BoxList& boxes,
                     const Field<float>& coarse_total, const Field<float>& coarse_mass);

}  // namespace peclet::flow
