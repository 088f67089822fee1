#include "flow/body_loads.hpp"

namespace peclet::flow {
namespace {

/// Bins of one body.
enum Bin : int { Viscous = 0, Pressure = 3, Torque = 6, bins_per_body = 9 };

/// Adds a force along axis c that acts at x; walls without an instance share the last set of bins.
struct LoadAdder {
  Bins bins;
  BodyGeometry geometry;
  int bodies;

  KOKKOS_INLINE_FUNCTION int first_bin(int owner) const {
    return bins_per_body * (owner >= 0 ? owner : bodies);
  }
  KOKKOS_INLINE_FUNCTION void add(int chunk, int owner, Bin kind, int c, Real force, Vec3 x) const {
    const int bin = first_bin(owner);
    bins.add(chunk, bin + kind + c, force);
    if (owner < 0) return;
    Vec3 along;
    along[c] = force;
    add_torque(chunk, owner, cross(geometry.lever(owner, x), along));
  }
  KOKKOS_INLINE_FUNCTION void add_torque(int chunk, int owner, Vec3 torque) const {
    for (int a = 0; a < 3; ++a) bins.add(chunk, first_bin(owner) + Torque + a, torque[a]);
  }
  /// Torque of the transposed stress mu n x Omega: r x (n x Omega) = n (r . Omega) - Omega (r . n). The wall
  /// at x has this area across axis, positive where the fluid is on its high side.
  KOKKOS_INLINE_FUNCTION void add_spin_resistance(int chunk, int owner, int axis, Real area, Real viscosity,
                                                  Vec3 x) const {
    if (owner < 0 || !geometry.bodies(owner).spins()) return;
    const Vec3 spin = geometry.bodies(owner).mean_twist.angular, arm = geometry.lever(owner, x);
    Vec3 normal;
    normal[axis] = area;
    add_torque(chunk, owner, viscosity * (dot(arm, spin) * normal - arm[axis] * area * spin));
  }
};

/// may_meet: these walls can belong to a narrow gap between bodies that move against each other.
void add_wall_tractions(int c, const MomentumTerms& terms, const SolidSampler& solid, const WallRows& rows,
                        bool may_meet, const Field<Real>& correction, const LoadAdder& adder,
                        const ScatterSum& sums) {
  const MomentumTerms t = terms;
  const SolidSampler sampler = solid;
  const WallRows w = rows;
  const Field<Real> e = correction;
  const LoadAdder loads = adder;
  const Real volume = terms.grid.cell_volume();
  const Real3 inverse{1 / terms.grid.spacing[0], 1 / terms.grid.spacing[1], 1 / terms.grid.spacing[2]};
  for_each_scattered(
      "flow::add_wall_tractions", rows.count, sums, KOKKOS_LAMBDA(Index row, int chunk) {
        if (w.superseded(row)) return;
        const Layout& layout = e.layout();
        const Index p = w.face(row);
        const Int3 cell = cell_of(layout, p);
        const Vec3 x = t.grid.face_center(c, cell[0], cell[1], cell[2]);
        const Field<Real>& v = t.extrapolated[c];
        const Real here = v[p] + t.implicit_weight * e[p];
        const NarrowGap gap = may_meet ? narrow_gap(sampler, c, cell[0], cell[1], cell[2]) : NarrowGap();
        for (int d = 0; d < WallRows::directions; ++d) {
          if (!w.is_wall(row, d)) continue;
          const int a = d / 2, owner = w.owner(row, d);
          Vec3 wall = x;
          wall[a] += (d % 2 ? 1 : -1) * t.grid.spacing[a] * w.distance(row, d);
          Real laplacian =
              w.weight(row, d) * (wall_velocity(sampler, gap, owner, c, wall, Motion::Mean) - here);
          if (!w.is_wall(row, d ^ 1)) {
            const Index q = d % 2 ? p - layout.stride(a) : p + layout.stride(a);
            laplacian += (w.weight(row, d ^ 1) - 1) * (v[q] + t.implicit_weight * e[q] - here);
          }
          const Real viscosity = t.density * t.kinematic_viscosity, area = volume * inverse[a];
          loads.add(chunk, owner, Viscous, c, -viscosity * area * inverse[a] * laplacian, wall);
          // the points of each of the three components see the whole wall
          loads.add_spin_resistance(chunk, owner, a, (d % 2 ? -area : area) / 3, viscosity, wall);
        }
      });
}

void add_wall_pressure(int c, const SolidSampler& solid, const WallRows& rows, const Field<Real>& pressure,
                       const Field<Real>& divergence, Real implicit_viscosity, const LoadAdder& adder,
                       const ScatterSum& sums) {
  const WallRows w = rows;
  const Field<Real> p = pressure, div = divergence;
  const Grid grid = solid.grid;
  const LoadAdder loads = adder;
  const Real area = grid.cell_volume() / grid.spacing[c];
  for_each_scattered(
      "flow::add_wall_pressure", rows.count, sums, KOKKOS_LAMBDA(Index row, int chunk) {
        if (w.superseded(row)) return;
        const Index n = w.face(row);
        const Int3 cell = cell_of(p.layout(), n);
        const Vec3 high = grid.cell_center(cell[0], cell[1], cell[2]);
        Vec3 low = high;
        low[c] -= grid.spacing[c];
        const Index m = n - p.layout().stride(c);
        if (w.is_wall(row, 2 * c))
          loads.add(chunk, w.owner(row, 2 * c), Pressure, c, -area * (p[m] + implicit_viscosity * div[m]),
                    low);
        if (w.is_wall(row, 2 * c + 1))
          loads.add(chunk, w.owner(row, 2 * c + 1), Pressure, c, area * (p[n] + implicit_viscosity * div[n]),
                    high);
      });
}

/// may_be_superseded: contacts of fixed bodies, which a moving band lists again.
void add_contacts(int c, const SolidSampler& solid, const ContactCells& contacts, bool may_be_superseded,
                  const SurroundingPressure& surrounding, const LoadAdder& adder, const ScatterSum& sums) {
  const ContactCells cells = contacts;
  const SurroundingPressure around = surrounding;
  const Field<int> mark = solid.marks;
  const LoadAdder loads = adder;
  const Grid grid = solid.grid;
  const Real area = grid.cell_volume() / grid.spacing[c];
  for_each_scattered(
      "flow::add_contact_pressure", contacts.count, sums, KOKKOS_LAMBDA(Index n, int chunk) {
        const Index p = cells.cell(n);
        if (may_be_superseded && mark[p] & cell_mark::in_band) return;
        const Int3 cell = cell_of(mark.layout(), p);
        const Real force = area * around.at(cell);
        const Vec3 x = grid.cell_center(cell[0], cell[1], cell[2]);
        loads.add(chunk, cells.low(n), Pressure, c, -force, x);
        loads.add(chunk, cells.high(n), Pressure, c, force, x);
      });
}

Vec3 triple(const std::vector<Real>& sums, std::size_t first) {
  return {sums[first], sums[first + 1], sums[first + 2]};
}

}  // namespace

void LoadCollector::start(int number_of_bodies) {
  bodies_ = number_of_bodies;
  sums_.reset(bins_per_body * (number_of_bodies + 1));
}

void LoadCollector::add_momentum(int c, const MomentumTerms& terms, const SolidSampler& solid,
                                 const WallRows& fixed_rows, const WallRows& moving_rows,
                                 const Field<Real>& correction) {
  const LoadAdder adder{sums_.bins(), solid.geometry, bodies_};
  add_wall_tractions(c, terms, solid, fixed_rows, false, correction, adder, sums_);
  add_wall_tractions(c, terms, solid, moving_rows, true, correction, adder, sums_);
}

void LoadCollector::add_pressure(int c, const SolidSampler& solid, const WallRows& fixed_rows,
                                 const WallRows& moving_rows, const Field<Real>& pressure,
                                 const Field<Real>& divergence, Real implicit_viscosity) {
  const LoadAdder adder{sums_.bins(), solid.geometry, bodies_};
  add_wall_pressure(c, solid, fixed_rows, pressure, divergence, implicit_viscosity, adder, sums_);
  add_wall_pressure(c, solid, moving_rows, pressure, divergence, implicit_viscosity, adder, sums_);
}

void LoadCollector::add_contact_pressure(int c, const SolidSampler& solid, const ContactCells& fixed_contacts,
                                         const ContactCells& moving_contacts,
                                         const SurroundingPressure& surrounding) {
  const LoadAdder adder{sums_.bins(), solid.geometry, bodies_};
  add_contacts(c, solid, fixed_contacts, true, surrounding, adder, sums_);
  add_contacts(c, solid, moving_contacts, false, surrounding, adder, sums_);
}

std::vector<BodyLoad> LoadCollector::finish() {
  const std::vector<Real> sums = sums_.totals();
  std::vector<BodyLoad> loads(static_cast<std::size_t>(bodies_));
  for (std::size_t b = 0; b < loads.size(); ++b) {
    const std::size_t first = b * bins_per_body;
    BodyLoad& load = loads[b];
    load.viscous_force = triple(sums, first + Viscous);
    load.pressure_force = triple(sums, first + Pressure);
    load.force = load.viscous_force + load.pressure_force;
    load.torque = triple(sums, first + Torque);
  }
  return loads;
}

}  // namespace peclet::flow
