#pragma once
// Ghost layers that repeat the far side of a periodic box, and sums over the whole domain. A distributed
// grid would exchange with its neighbours here; nothing else in the code knows where ghosts come from.
#include "core/field.hpp"
#include "core/loop.hpp"

namespace peclet {

struct Periodicity {
  bool axis[3] = {true, true, true};
};

/// The axes whose ghosts count: what happens in a box that keeps away from both sides depends on none.
struct GhostAxes {
  bool axis[3] = {true, true, true};

  GhostAxes() = default;
  GhostAxes(const Int3& cells, const Box& box) {
    for (int a = 0; a < 3; ++a)
      axis[a] = box.low[a] <= Layout::ghost_width || box.high[a] >= cells[a] - Layout::ghost_width;
  }
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

namespace detail {

template <int axis, class Body>
void for_each_in_layers_along(const std::string& label, const Layout& layout, const Box& layers,
                              const Body& body) {
  // rows run across the layers: along x, or along y where the layers are those of x
  const auto turned = [](const Int3& at) { return axis == 0 ? Int3{at[1], at[2], at[0]} : at; };
  for_each_cell(
      label, Box{turned(layers.low), turned(layers.high)}, KOKKOS_LAMBDA(int a, int b, int c) {
        const Index first = axis == 0 ? layout(0, a, b) : (axis == 1 ? layout(a, 0, c) : layout(a, b, 0));
        body(first, axis == 1 ? b : c);
      });
}

}  // namespace detail

/// body(first, depth) for each place of the layers along axis: first is the linear index of the first cell
/// of the line along axis.
template <class Body>
void for_each_in_layers(const std::string& label, const Layout& layout, int axis, const Box& layers,
                        const Body& body) {
  if (axis == 0)
    detail::for_each_in_layers_along<0>(label, layout, layers, body);
  else if (axis == 1)
    detail::for_each_in_layers_along<1>(label, layout, layers, body);
  else
    detail::for_each_in_layers_along<2>(label, layout, layers, body);
}

/// Fill the ghost layers beyond both sides of one periodic axis: layers.low[axis] to layers.high[axis] count
/// depths from the side; along the other axes layers gives the cells (and ghosts) to treat. Cells along
/// short axes (fewer cells than ghosts) repeat as often as needed.
template <class T>
void fill_periodic_layers(const Field<T>& field, int axis, const Box& layers) {
  const int n = field.layout().cells[axis];
  const Index step = field.layout().stride(axis);
  for_each_in_layers(
      "core::fill_periodic_ghosts", field.layout(), axis, layers, KOKKOS_LAMBDA(Index first, int depth) {
        const int inside = depth < n ? depth : depth % n;
        field[first - (1 + depth) * step] = field[first + (n - 1 - inside) * step];
        field[first + (n + depth) * step] = field[first + inside * step];
      });
}

/// sign * the mirror image about the side, for values at cell centres.
template <class T>
void fill_reflected_layers(const Field<T>& field, int axis, const Box& layers, T low_sign, T high_sign) {
  const int n = field.layout().cells[axis];
  const Index step = field.layout().stride(axis);
  for_each_in_layers(
      "core::fill_reflected_ghosts", field.layout(), axis, layers, KOKKOS_LAMBDA(Index first, int depth) {
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
