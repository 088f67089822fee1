#include "flow/region_list.hpp"

#include <algorithm>

#include "core/field_transfer.hpp"

namespace peclet::flow {
namespace {

bool overlap_on_axis(const Box& a, const Box& b, int axis, int n) {
  for (int shift = -n; shift <= n; shift += n)
    if (a.low[axis] < b.high[axis] + shift && b.low[axis] + shift < a.high[axis]) return true;
  return false;
}

bool overlap(const Box& a, const Box& b, const Int3& cells) {
  return overlap_on_axis(a, b, 0, cells[0]) && overlap_on_axis(a, b, 1, cells[1]) &&
         overlap_on_axis(a, b, 2, cells[2]);
}

/// Smallest box around two; they are not wrapped.
Box hull(const Box& a, const Box& b) {
  Box box;
  for (int axis = 0; axis < 3; ++axis) {
    box.low[axis] = std::min(a.low[axis], b.low[axis]);
    box.high[axis] = std::max(a.high[axis], b.high[axis]);
  }
  return box;
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
}

std::vector<Box> joined(const std::vector<Box>& first, const std::vector<Box>& second) {
  std::vector<Box> both;
  const std::size_t pairs = first.size() == second.size() ? first.size() : 0;
  for (std::size_t b = 0; b < pairs; ++b) {
    const Box around = hull(first[b], second[b]);
    const bool is_small = around.size() <= first[b].size() + second[b].size();
    both.push_back(is_small ? around : first[b]);
    if (!is_small) both.push_back(second[b]);
  }
  both.insert(both.end(), first.begin() + static_cast<std::ptrdiff_t>(pairs), first.end());
  both.insert(both.end(), second.begin() + static_cast<std::ptrdiff_t>(pairs), second.end());
  return both;
}

std::vector<Box> cut_inside(const std::vector<Box>& boxes, const Int3& cells) {
  std::vector<Box> inside;
  for (const Box& box : boxes) {
    std::vector<Box> pieces{box};
    for (int axis = 0; axis < 3; ++axis) {
      const int n = cells[axis];
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
