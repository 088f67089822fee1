#include "flow/region_list.hpp"

#include <algorithm>

namespace peclet::flow {
namespace {

template <class T>
void upload(const std::string& name, const std::vector<T>& values, Array<T>& device) {
  if (device.extent(0) < values.size()) device = Array<T>(name, values.size() + values.size() / 2 + 16);
  if (values.empty()) return;
  const Kokkos::View<const T*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> host(
      values.data(), values.size());
  Kokkos::deep_copy(Kokkos::subview(device, Kokkos::pair<std::size_t, std::size_t>(0, values.size())), host);
}

bool overlap_on_axis(const Box& a, const Box& b, int axis, int n) {
  for (int shift = -n; shift <= n; shift += n)
    if (a.low[axis] < b.high[axis] + shift && b.low[axis] + shift < a.high[axis]) return true;
  return false;
}

bool overlap(const Box& a, const Box& b, const Int3& cells) {
  return overlap_on_axis(a, b, 0, cells[0]) && overlap_on_axis(a, b, 1, cells[1]) &&
         overlap_on_axis(a, b, 2, cells[2]);
}

void list_cells(const RegionView& view, Index total) {
  const RegionView target = view;
  for_each(
      "flow::list_region_cells", total, KOKKOS_LAMBDA(Index n) { target.listed(n) = target.find_cell(n); });
}

}  // namespace

void RegionList::assign(const std::vector<Box>& boxes, const std::vector<int>& bodies) {
  boxes_ = boxes;
  std::vector<Index> first_cell{0};
  std::vector<int> first_neighbor{0}, neighbors;
  for (std::size_t b = 0; b < boxes.size(); ++b) {
    first_cell.push_back(first_cell.back() + boxes[b].size());
    for (std::size_t other = 0; other < boxes.size(); ++other)
      if (overlap(boxes[b], boxes[other], view_.cells)) neighbors.push_back(static_cast<int>(other));
    first_neighbor.push_back(static_cast<int>(neighbors.size()));
  }
  total_ = first_cell.back();
  view_.count = static_cast<int>(boxes.size());
  upload("flow::region_boxes", boxes, view_.boxes);
  upload("flow::region_first_cell", first_cell, view_.first_cell);
  upload("flow::region_body", bodies, view_.body);
  upload("flow::region_first_neighbor", first_neighbor, view_.first_neighbor);
  upload("flow::region_neighbors", neighbors, view_.neighbors);
  if (view_.count < 2) return;
  if (static_cast<Index>(view_.listed.extent(0)) < total_)
    view_.listed = Array<RegionCell>("flow::region_cells", static_cast<std::size_t>(total_ + total_ / 4));
  list_cells(view_, total_);
}

std::vector<Box> RegionList::boxes_inside() const {
  std::vector<Box> inside;
  for (const Box& box : boxes_) {
    std::vector<Box> pieces{box};
    for (int axis = 0; axis < 3; ++axis) {
      const int n = view_.cells[axis];
      std::vector<Box> cut;
      for (Box piece : pieces) {
        if (piece.high[axis] > n) {
          Box wrapped = piece;
          wrapped.low[axis] = 0;
          wrapped.high[axis] = piece.high[axis] - n;
          piece.high[axis] = n;
          cut.push_back(wrapped);
        }
        cut.push_back(piece);
      }
      pieces = cut;
    }
    inside.insert(inside.end(), pieces.begin(), pieces.end());
  }
  return inside;
}

}  // namespace peclet::flow
