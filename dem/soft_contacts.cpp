#include "dem/soft_contacts.hpp"

#include <numbers>
#include <utility>

#include "dem/make_room.hpp"
#include "dem/wall_features.hpp"

namespace peclet::dem {
namespace {

/// Move bodies into the domain, and particles by the same periods; remember where the bodies are.
void wrap_and_list(const ContactScene& scene, const Bodies& bodies, const Array<Vec3>& listed) {
  for_each(
      "dem::wrap_and_list", scene.particles.count, KOKKOS_LAMBDA(Index n) {
        const Vec3 wrapped = scene.domain.wrap(bodies(n).position);
        const Vec3 periods = wrapped - bodies(n).position;
        if (periods.x != 0 || periods.y != 0 || periods.z != 0) scene.particles.position(n) += periods;
        bodies(n).position = wrapped;
        listed(n) = wrapped;
      });
}

/// Largest way since the list was made, over half the skin.
Real largest_way(const ContactScene& scene, const Bodies& bodies, const Array<Vec3>& listed) {
  return max_each(
      "dem::largest_way", scene.particles.count, KOKKOS_LAMBDA(Index n) {
        const Real skin = scene.margin * scene.shape_radius * scene.particles.scale(n);
        const Real way = norm(bodies(n).position - listed(n));
        return way == way ? 2 * way / skin : Real{2};
      });
}

void write_elastic_pairs(const ContactScene& scene, const SoftContacts& list) {
  for_each(
      "dem::write_elastic_pairs", list.keys.count, KOKKOS_LAMBDA(Index n) {
        const ContactKey key = list.keys.keys(n);
        const int a = scene.particles.material(key.a);
        const int b =
            key.b >= 0 ? scene.particles.material(key.b) : scene.walls.walls(-1 - key.b).elastic_id();
        list.elastic(n) = ElasticPair(scene.materials.elastic(a), scene.materials.elastic(b));
      });
}

void recall_springs(const SpringHistory& history, const SoftContacts& list) {
  for_each(
      "dem::recall_springs", list.keys.count, KOKKOS_LAMBDA(Index n) {
        list.springs(n) = recall_spring(history, list.keys.keys(n), list.contacts(n));
      });
}

void write_identity(Index count, const Array<Index>& place) {
  for_each("dem::write_identity", count, KOKKOS_LAMBDA(Index n) { place(n) = n; });
}

void count_incident(const ContactKeys& keys, const Array<Index>& sizes) {
  for_each("dem::clear_incident", keys.rows, KOKKOS_LAMBDA(Index n) { sizes(n) = 0; });
  for_each(
      "dem::count_incident", keys.count, KOKKOS_LAMBDA(Index n) {
        if (keys.keys(n).b >= 0) Kokkos::atomic_inc(&sizes(keys.keys(n).b));
      });
}

Index sum_incident(Index rows, const Array<Index>& sizes, const Array<Index>& begin) {
  return exclusive_sum("dem::sum_incident", rows, begin, KOKKOS_LAMBDA(Index n) { return sizes(n); });
}

/// Each list is sorted, so that sums do not depend on the order in which threads wrote it.
void fill_incident(const SoftContacts& list, const Array<Index>& sizes) {
  for_each(
      "dem::fill_incident", list.keys.count, KOKKOS_LAMBDA(Index n) {
        const int b = list.keys.keys(n).b;
        if (b < 0) return;
        list.incident(list.incident_begin(b) + Kokkos::atomic_fetch_sub(&sizes(b), Index{1}) - 1) = n;
      });
  for_each(
      "dem::sort_incident", list.keys.rows, KOKKOS_LAMBDA(Index p) {
        for (Index i = list.incident_begin(p) + 1; i < list.incident_begin(p + 1); ++i) {
          const Index n = list.incident(i);
          Index hole = i;
          for (; hole > list.incident_begin(p) && list.incident(hole - 1) > n; --hole)
            list.incident(hole) = list.incident(hole - 1);
          list.incident(hole) = n;
        }
      });
}

KOKKOS_INLINE_FUNCTION void compute_pair_load(const SoftContacts& list, const Bodies& bodies, Real dt,
                                              Index n) {
  const Contact& c = list.contacts(n);
  const RelativeMotion now = relative_motion(c, bodies);
  const SoftMotion motion{now.distance, now.velocity, now.acceleration, dt};
  list.loads(n) = hertz_load(c, list.elastic(n), bodies, motion, normal_of(c, now.distance), list.springs(n));
}

/// Contact n is the first of particle and wall.
KOKKOS_FUNCTION void compute_wall_loads(const ContactScene& scene, const SoftContacts& list,
                                        const Bodies& bodies, Index n) {
  const ContactKey key = list.keys.keys(n);
  const Contact& c = list.contacts(n);
  const Body& a = bodies(key.a);
  const Index end = list.keys.row_begin(key.a + 1);
  ContactSpring former[WallArrays::maximum_features];
  int slots = 0;
  for (; n + slots < end && list.keys.keys(n + slots).b == key.b; ++slots)
    former[slots] = list.springs(n + slots);
  WallFeature features[WallArrays::maximum_features];
  const int found =
      scene.walls.features_near(scene.walls.walls(-1 - key.b), a.position, c.reach, c.reach, features);
  for (int k = 0; k < slots; ++k) {
    list.springs(n + k) = {};
    list.loads(n + k) = {};
    if (k >= found) continue;
    const WallFeature& feature = features[k];
    ContactSpring spring = take_spring(former, slots, feature.normal);
    const SoftMotion motion{a.position - feature.point, a.velocity - feature.velocity, a.acceleration,
                            scene.dt};
    list.loads(n + k) = hertz_load(c, list.elastic(n), bodies, motion, feature.normal, spring);
    list.springs(n + k) = spring;
  }
}

void compute_loads(const ContactScene& scene, const SoftContacts& list, const Bodies& bodies) {
  for_each(
      "dem::compute_loads", list.keys.count, KOKKOS_LAMBDA(Index n) {
        const ContactKey key = list.keys.keys(n);
        if (key.b >= 0)
          compute_pair_load(list, bodies, scene.dt, n);
        else if (key.image == 0)
          compute_wall_loads(scene, list, bodies, n);
      });
}

void gather_loads(const SoftContacts& list, const ParticleLoads& loads) {
  for_each(
      "dem::gather_loads", list.keys.rows, KOKKOS_LAMBDA(Index p) {
        Vec3 force, torque;
        for (Index n = list.keys.row_begin(p); n < list.keys.row_begin(p + 1); ++n) {
          force += list.loads(n).force;
          torque += list.loads(n).moment_on_a;
        }
        for (Index i = list.incident_begin(p); i < list.incident_begin(p + 1); ++i) {
          force -= list.loads(list.incident(i)).force;
          torque += list.loads(list.incident(i)).moment_on_b;
        }
        loads.force(p) = force;
        loads.torque(p) = torque;
      });
}

bool operator==(const Domain& p, const Domain& q) {
  bool is_same = true;
  for (int axis = 0; axis < 3; ++axis)
    is_same = is_same && p.origin[axis] == q.origin[axis] && p.extent[axis] == q.extent[axis] &&
              p.periodic[axis] == q.periodic[axis];
  return is_same;
}

bool is_same_origin(const ListOrigin& p, const ListOrigin& q) {
  return p.particles == q.particles && p.walls == q.walls && p.materials == q.materials && p.skin == q.skin &&
         p.domain == q.domain;
}

Real largest_speed(const ParticleArrays& particles) {
  return max_each(
      "dem::largest_speed", particles.count, KOKKOS_LAMBDA(Index n) { return norm(particles.velocity(n)); });
}

struct ElasticSphere {
  Real mass, radius;
  ElasticMaterial material;
};

/// pi R sqrt(rho / G) / (0.1631 nu + 0.8766)
KOKKOS_INLINE_FUNCTION Real rayleigh_time(const ElasticSphere& s) {
  constexpr Real pi = std::numbers::pi;
  const Real density = s.mass / (4 * pi / 3 * s.radius * s.radius * s.radius);
  const Real shear = 0.5 * s.material.young / (1 + s.material.poisson);
  return pi * s.radius * Kokkos::sqrt(density / shear) / (0.1631 * s.material.poisson + 0.8766);
}

/// 2.86827 (m*^2 / (R* E*^2 v))^(1/5) of two equal spheres
KOKKOS_INLINE_FUNCTION Real impact_time(const ElasticSphere& s, Real speed) {
  const Real young = ElasticPair(s.material, s.material).young;
  return 2.86827 * Kokkos::pow(0.25 * s.mass * s.mass / (0.5 * s.radius * young * young * speed), Real{0.2});
}

/// Largest of the inverse times; speed 0 means the Rayleigh time.
Real largest_rate(const ContactScene& scene, bool of_impact, Real largest) {
  return max_each(
      "dem::largest_rate", scene.particles.count, KOKKOS_LAMBDA(Index n) {
        const ParticleArrays& p = scene.particles;
        if (p.inverse_mass(n) == 0) return Real{0};
        const ElasticSphere sphere{1 / p.inverse_mass(n), scene.shape_radius * p.scale(n),
                                   scene.materials.elastic(p.material(n))};
        if (!of_impact) return 1 / rayleigh_time(sphere);
        const Real speed = norm(p.velocity(n)) + largest;
        return speed > 0 ? 1 / impact_time(sphere, speed) : Real{0};
      });
}

}  // namespace

SoftTimeScales soft_time_scales(const ContactScene& scene) {
  return {1 / largest_rate(scene, false, 0), 1 / largest_rate(scene, true, largest_speed(scene.particles))};
}

int find_material_without_elasticity(const ContactScene& scene) {
  return static_cast<int>(max_each(
             "dem::find_material_without_elasticity", scene.particles.count,
             KOKKOS_LAMBDA(Index n) {
               const int id = scene.particles.material(n);
               return scene.materials.elastic(id).young > 0 ? Real{0} : static_cast<Real>(id + 1);
             })) -
         1;
}

void SoftContactSolver::forget() {
  list_.keys.rows = list_.keys.count = 0;
  origin_ = {};
}

bool SoftContactSolver::serves(const ContactScene& scene, const ListOrigin& origin,
                               const Bodies& bodies) const {
  return is_same_origin(origin, origin_) && list_.keys.rows == scene.particles.count &&
         largest_way(scene, bodies, listed_positions_) <= 1;
}

void SoftContactSolver::rebuild(ContactScene& scene, const Bodies& bodies) {
  std::swap(list_.keys, history_.keys);
  std::swap(list_.springs, history_.springs);
  ContactScene at_rest = scene;
  at_rest.dt = 0;
  make_room(listed_positions_, "dem.listed_positions", scene.particles.count);
  wrap_and_list(scene, bodies, listed_positions_);
  at_rest.particles.position = listed_positions_;
  finder_.find(at_rest, bodies, list_.keys);

  const Index count = list_.keys.count, rows = list_.keys.rows;
  make_room(place_, "dem.place", count);
  write_identity(count, place_);
  build_contacts(at_rest, list_.keys, place_, {}, list_.contacts);
  make_room(list_.elastic, "dem.elastic_pairs", count);
  make_room(list_.springs, "dem.springs", count);
  make_room(list_.loads, "dem.soft_loads", count);
  write_elastic_pairs(scene, list_);
  recall_springs(history_, list_);
  make_room(incident_sizes_, "dem.incident_sizes", rows);
  make_room(list_.incident_begin, "dem.incident_begin", rows + 1);
  make_room(list_.incident, "dem.incident", count);
  count_incident(list_.keys, incident_sizes_);
  sum_incident(rows, incident_sizes_, list_.incident_begin);
  fill_incident(list_, incident_sizes_);
}

ParticleLoads SoftContactSolver::solve(ContactScene& scene, const ListOrigin& origin, const Bodies& bodies) {
  if (!serves(scene, origin, bodies)) {
    rebuild(scene, bodies);
    origin_ = origin;
  }
  make_room(loads_.force, "dem.contact_force", scene.particles.count);
  make_room(loads_.torque, "dem.contact_torque", scene.particles.count);
  compute_loads(scene, list_, bodies);
  gather_loads(list_, loads_);
  return loads_;
}

}  // namespace peclet::dem
