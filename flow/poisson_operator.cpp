#include "flow/poisson_operator.hpp"

#include <algorithm>
#include <cmath>

#include "flow/group_transfer.hpp"

namespace peclet::flow {
namespace {

constexpr int vector_length = Layout::alignment;

/// Sum of the fine coefficients on a coarse face normal to axis, scaled to the coarse distance.
template <class Operator>
KOKKOS_INLINE_FUNCTION float coarse_coefficient(const Operator& fine, const LevelShape& coarse,
                                                const Merging& merging, int axis, const Int3& face) {
  if (coarse.is_collapsed(axis)) return 0;
  const Layout& layout = fine.shape.layout;
  Int3 low;
  Index step[3];  // to the second fine face along each edge, if there is one
  for (int a = 0; a < 3; ++a) {
    const int n = fine.shape.cells[a];
    const int first = merging.first_child(a, face[a]), end = merging.end_of_children(a, face[a]);
    low[a] = first < n ? first : n;
    step[a] = (end < n ? end : n) - low[a] > 1 ? layout.stride(a) : 0;
  }
  const int b = (axis + 1) % 3, c = (axis + 2) % 3;
  const Index first = layout(low[0], low[1], low[2]);
  const Index to_cell = low[axis] < fine.shape.cells[axis] ? 0 : -layout.stride(axis);
  const auto value = [&](Index step) { return fine.coefficient(axis, first + step, first + step + to_cell); };
  Real sum = value(0);
  if (step[b]) sum += value(step[b]);
  if (step[c]) sum += value(step[c]);
  if (step[b] && step[c]) sum += value(step[b] + step[c]);
  return static_cast<float>(sum * fine.weight[axis] * fine.shape.twice_distance(axis, low[axis]) /
                            coarse.twice_distance(axis, face[axis]));
}

}  // namespace

template <class Operator>
void derive_coefficients(const Operator& fine, const LevelShape& coarse, const Merging& merging,
                         const BoxList& boxes, const FaceVector<float>& coefficients) {
  const FaceVector<float> c = coefficients;
  for_each_cell(
      "flow::coarsen", boxes, KOKKOS_LAMBDA(int i, int j, int k) {
        const Int3 cell{i, j, k};
        for (int axis = 0; axis < 3; ++axis) {
          Int3 face = cell;
          c[axis](face[0], face[1], face[2]) = coarse_coefficient(fine, coarse, merging, axis, face);
          if (++face[axis] == coarse.cells[axis])
            c[axis](face[0], face[1], face[2]) = coarse_coefficient(fine, coarse, merging, axis, face);
        }
      });
}

template void derive_coefficients(const LevelOperator<OpenFraction>&, const LevelShape&, const Merging&,
                                  const BoxList&, const FaceVector<float>&);
template void derive_coefficients(const GroupOperator&, const LevelShape&, const Merging&, const BoxList&,
                                  const FaceVector<float>&);
template void derive_coefficients(const LevelOperator<float>&, const LevelShape&, const Merging&,
                                  const BoxList&, const FaceVector<float>&);

void mark_open_vectors(const LevelOperator<OpenFraction>& op, const BoxList& boxes,
                       const Array<unsigned char>& open_vectors) {
  const LevelOperator<OpenFraction> all = op;
  for_each_cell(
      "flow::open_vectors", boxes, KOKKOS_LAMBDA(int vector, int j, int k) {
        const Layout& layout = all.shape.layout;
        const Index begin = layout(vector * vector_length, j, k);
        // a vector that reaches beyond the row would treat padding as open cells
        bool open = (vector + 1) * vector_length <= all.shape.cells[0];
        for (Index n = begin; open && n < begin + vector_length; ++n)
          open = all.x[n] == fully_open && all.x[n + 1] == fully_open && all.y[n] == fully_open &&
                 all.y[n + layout.pitch_y] == fully_open && all.z[n] == fully_open &&
                 all.z[n + layout.pitch_z] == fully_open;
        open_vectors(begin / vector_length) = open;
      });
}

void derive_reaction(const Reaction& fine, const Merging& merging, const BoxList& boxes,
                     const Field<float>& coarse_total, const Field<float>& coarse_mass) {
  const Field<float> from = fine.total, from_mass = fine.mass, to = coarse_total, to_mass = coarse_mass;
  const Int3 fine_cells = fine.shape.cells;
  const Real cell_mass = fine.cell_mass;
  const bool has_field = from_mass.is_allocated();
  Real share = 0;
  for (int axis = 0; axis < 3; ++axis)
    share += fine.from_coarse_centres ? 1.0 / 3 : 1.0 / (3 * merging.ratio[axis]);
  for_each_cell(
      "flow::coarsen_reaction", boxes, KOKKOS_LAMBDA(int i, int j, int k) {
        const Box box = merging.children({i, j, k}, fine_cells);
        Real total = 0, mass = 0;
        for (int c = box.low[2]; c < box.high[2]; ++c)
          for (int b = box.low[1]; b < box.high[1]; ++b)
            for (int a = box.low[0]; a < box.high[0]; ++a) {
              const Real here = from(a, b, c);
              total += here;
              mass += has_field ? Real(from_mass(a, b, c)) : (here < cell_mass ? here : cell_mass);
            }
        to_mass(i, j, k) = static_cast<float>(mass);
        to(i, j, k) = static_cast<float>(mass + share * (total - mass));
      });
}

RowRanges aligned_rows(const RowRanges& rows, const LevelShape& shape) {
  return coarse_rows(rows, shape, Merging());
}

RowRanges coarse_rows(const RowRanges& fine, const LevelShape& coarse, const Merging& merging) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = merging.parent(axis, fine.box.low[axis]);
    box.high[axis] = merging.end_of_parents(axis, fine.box.high[axis]);
  }
  const int n = coarse.cells[0];
  box.low[0] = box.low[0] / vector_length * vector_length;
  box.high[0] = std::min(n, (box.high[0] + vector_length - 1) / vector_length * vector_length);
  RowRanges rows(box);
  if (!fine.first.data()) return rows;

  const Index number_of_rows = rows.number_of_rows(), ny = box.extent(1), fine_ny = fine.box.extent(1);
  const Array<int> first("row_begin", number_of_rows), last("row_end", number_of_rows);
  for_each(
      "flow::rows", number_of_rows, KOKKOS_LAMBDA(Index row) {
        const int j = box.low[1] + static_cast<int>(row % ny), k = box.low[2] + static_cast<int>(row / ny);
        int begin = fine.box.high[0], end = fine.box.low[0];
        for (int fk = merging.first_child(2, k); fk < merging.end_of_children(2, k); ++fk)
          for (int fj = merging.first_child(1, j); fj < merging.end_of_children(1, j); ++fj) {
            if (!fine.box.contains(fine.box.low[0], fj, fk)) continue;
            const Index n = (fj - fine.box.low[1]) + (fk - fine.box.low[2]) * fine_ny;
            if (fine.begin(n) >= fine.end(n)) continue;
            begin = fine.begin(n) < begin ? fine.begin(n) : begin;
            end = fine.end(n) > end ? fine.end(n) : end;
          }
        if (begin < end) {
          begin = merging.parent(0, begin) / vector_length * vector_length;
          end = (merging.end_of_parents(0, end) + vector_length - 1) / vector_length * vector_length;
        }
        first(row) = begin < end ? begin : 0;
        last(row) = begin < end ? (end < n ? end : n) : 0;
      });
  rows.first = first;
  rows.last = last;
  return rows;
}

}  // namespace peclet::flow
