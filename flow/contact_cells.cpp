#include "flow/contact_cells.hpp"

namespace peclet::flow {

void ContactCells::reserve(Index capacity) {
  const auto n = static_cast<std::size_t>(capacity);
  if (cell.extent(0) >= n) return;
  cell = Array<Index>("flow::contact_cells.cell", n + n / 4);
  low = Array<int>("flow::contact_cells.low", n + n / 4);
  high = Array<int>("flow::contact_cells.high", n + n / 4);
}

namespace {

constexpr int side_of_box = sampled_solid - 1;

/// Bodies that close the faces of a cell along an axis; the same twice where this is no contact.
struct ClosingBodies {
  int low = no_owner, high = no_owner;
};

KOKKOS_INLINE_FUNCTION ClosingBodies closing_bodies(const SolidSampler& solid,
                                                    const FaceVector<OpenFraction>& open,
                                                    const DomainSides& sides, int c, const Int3& cell) {
  const Layout& layout = open.x.layout();
  const Index p = layout(cell[0], cell[1], cell[2]), next = p + layout.stride(c);
  if (is_fluid(open[c][p]) || is_fluid(open[c][next])) return {};
  const Vec3 x = solid.grid.face_center(c, cell[0], cell[1], cell[2]);
  Vec3 beyond = x;
  beyond[c] += solid.grid.spacing[c];
  const bool is_first = sides.is_side(c, cell[c], layout.cells);
  const bool is_last = sides.is_side(c, cell[c] + 1, layout.cells);
  if (is_first && is_last) return {};
  ClosingBodies bodies;
  bodies.low = is_first ? side_of_box : nearest_owner(solid, c, p, x);
  bodies.high = is_last ? side_of_box : nearest_owner(solid, c, next, beyond);
  const int touching = is_first ? bodies.high : bodies.low;
  if ((is_first || is_last) && (touching < 0 || solid.geometry.bodies(touching).is_cut[c][is_last]))
    return {};
  return bodies;
}

}  // namespace

void build_contact_cells(int c, const SolidSampler& solid, const FaceVector<OpenFraction>& open,
                         const DomainSides& sides, const CellList& near, const Array<Index>& scratch,
                         ContactCells& contacts) {
  const CellList candidates = near;
  const SolidSampler sampler = solid;
  const FaceVector<OpenFraction> fraction = open;
  const DomainSides box = sides;
  contacts.count = list_where(
      "flow::list_contact_cells", near.count, scratch, KOKKOS_LAMBDA(Index n) {
        const ClosingBodies bodies = closing_bodies(sampler, fraction, box, c, candidates.cell(n));
        return bodies.low != bodies.high;
      });
  contacts.reserve(contacts.count);
  const ContactCells target = contacts;
  for_each(
      "flow::build_contact_cells", contacts.count, KOKKOS_LAMBDA(Index n) {
        const Int3 cell = candidates.cell(scratch(n));
        const ClosingBodies bodies = closing_bodies(sampler, fraction, box, c, cell);
        target.cell(n) = fraction.x.layout()(cell[0], cell[1], cell[2]);
        target.low(n) = bodies.low;
        target.high(n) = bodies.high;
      });
}

}  // namespace peclet::flow
