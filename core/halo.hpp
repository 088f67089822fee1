#pragma once
// Ghost layers that repeat the far side of a periodic box, and sums over the whole domain. A distributed
// grid would exchange with its neighbours here; nothing else in the code knows where ghosts come from.
#include "core/field.hpp"
#include "core/loop.hpp"

namespace peclet {

struct Periodicity {
  bool axis[3] = {true, true, true};
};

/// The layers on both sides of one axis, with the ghosts that the axes before it have filled: depth counts
/// the layers from each side, 0 being the one next to it.
inline Box ghost_layers(const Int3& cells, int axis, int width) {
  Box layers{{-width, -width, -width}, cells};
  for (int a = 0; a < 3; ++a) {
    if (a < axis) layers.high[a] += width;
    if (a > axis) layers.low[a] = 0;
  }
  layers.low[axis] = 0;
  layers.high[axis] = width;
  return layers;
}

/// Fill the ghost layers beyond both sides of one periodic axis: layers.low[axis] to layers.high[axis] count
/// depths from the side; along the other axes layers gives the cells (and ghosts) to treat. Cells along
/// short axes (fewer cells than ghosts) repeat as often as needed.
template <class T>
void fill_periodic_layers(const Field<T>& field, int axis, const Box& layers) {
  const int m = field.layout().cells[axis];
  for_each_cell(
      "core::fill_periodic_ghosts", layers, KOKKOS_LAMBDA(int i, int j, int k) {
        const int depth = axis == 0 ? i : (axis == 1 ? j : k);  // 0 is the layer next to the cells
        const int source_high = depth % m;
        const int source_low = m - 1 - source_high;
        const int ni = axis == 0, nj = axis == 1, nk = axis == 2;
        const int bi = i * !ni, bj = j * !nj, bk = k * !nk;
        field(bi + ni * (m + depth), bj + nj * (m + depth), bk + nk * (m + depth)) =
            field(bi + ni * source_high, bj + nj * source_high, bk + nk * source_high);
        field(bi - ni * (1 + depth), bj - nj * (1 + depth), bk - nk * (1 + depth)) =
            field(bi + ni * source_low, bj + nj * source_low, bk + nk * source_low);
      });
}

/// sign * the mirror image about the side, for values at cell centres.
template <class T>
void fill_reflected_layers(const Field<T>& field, int axis, const Box& layers, T low_sign, T high_sign) {
  const int n = field.layout().cells[axis];
  const Index step = field.layout().stride(axis);
  for_each_cell(
      "core::fill_reflected_ghosts", layers, KOKKOS_LAMBDA(int i, int j, int k) {
        const int depth = axis == 0 ? i : (axis == 1 ? j : k);
        const Index first = field.layout()(i, j, k) - depth * step;
        const int inside = depth < n ? depth : n - 1;
        field[first - (1 + depth) * step] = static_cast<T>(low_sign * field[first + inside * step]);
        field[first + (n + depth) * step] =
            static_cast<T>(high_sign * field[first + (n - 1 - inside) * step]);
      });
}

/// Fill width ghost layers (at most Layout::ghost_width) along the periodic axes, edges and corners
/// included.
template <class T>
void fill_periodic_ghosts(const Field<T>& field, const Periodicity& periodic,
                          int width = Layout::ghost_width) {
  const Int3 n = field.layout().cells;
  Int3 low{0, 0, 0}, high = n;
  for (int axis = 0; axis < 3; ++axis) {
    if (periodic.axis[axis]) {
      Box ghosts{low, high};
      ghosts.low[axis] = 0;
      ghosts.high[axis] = width;
      fill_periodic_layers(field, axis, ghosts);
    }
    low[axis] = periodic.axis[axis] ? -width : 0;
    high[axis] = n[axis] + (periodic.axis[axis] ? width : 0);
  }
}

}  // namespace peclet
