#include "dem/contact_detection.hpp"

#include <limits>

#include "core/error.hpp"
#include "dem/make_room.hpp"
#include "dem/wall_features.hpp"

namespace peclet::dem {
namespace {

constexpr Real largest_sweep = 4;  // in radii

KOKKOS_INLINE_FUNCTION Real radius_of(const ContactScene& scene, Index n) {
  return scene.shape_radius * scene.particles.scale(n);
}

/// Distance from the centre at which a contact begins.
void compute_reaches(const ContactScene& scene, const Bodies& bodies) {
  for_each(
      "dem::compute_reaches", scene.particles.count, KOKKOS_LAMBDA(Index n) {
        const Real radius = radius_of(scene, n);
        const Real sweep =
            norm(bodies(n).velocity) * scene.dt + norm(bodies(n).acceleration) * scene.dt * scene.dt;
        scene.reaches(n) = (1 + 0.5 * scene.margin) * radius + Kokkos::min(sweep, largest_sweep * radius);
      });
}

/// The particle of larger reach looks for the others (of equals, the later one): it never has to look further
/// than twice its own reach, so that small particles do not search for large ones.
struct PairVisitor {
  const ParticleArrays& particles;
  int a;
  Vec3 position;
  Real reach;
  bool a_is_fixed;
  ContactKey* row;
  int room;  // keys beyond it are only counted
  int count = 0;

  KOKKOS_FUNCTION void operator()(const CellList::Entry& entry, Vec3 shift, int image) {
    const int b = entry.particle;
    if (entry.reach > reach || (entry.reach == reach && b >= a) || b == a) return;
    const Vec3 d = position - entry.position - shift;
    const Real limit = reach + entry.reach;
    if (!(dot(d, d) < limit * limit)) return;
    if (a_is_fixed && particles.inverse_mass(b) == 0) return;
    if (count < room) row[count] = {a, b, image};
    ++count;
  }
};

KOKKOS_INLINE_FUNCTION int wall_features(const ContactScene& scene, Index a, const Wall& wall,
                                         WallFeature* features) {
  const Real radius = radius_of(scene, a);
  const Vec3 x = scene.particles.position(a);
  const Real wall_speed = norm(velocity_at(wall.twist, wall.center, x));
  const Real margin = 0.5 * scene.margin * radius;
  return scene.walls.features_near(
      wall, x, radius, scene.reaches(a) + margin + Kokkos::min(wall_speed * scene.dt, largest_sweep * radius),
      features);
}

/// Number of contacts of particle a; as many as there is room for are written to row.
KOKKOS_FUNCTION int collect_row(const ContactScene& scene, const CellList& cells, Index a, ContactKey* row,
                                int room) {
  const Real reach = scene.reaches(a);
  const bool is_fixed = scene.particles.inverse_mass(a) == 0;
  PairVisitor pairs{
      scene.particles, static_cast<int>(a), scene.particles.position(a), reach, is_fixed, row, room};
  cells.visit_near(scene.particles.position(a), 2 * reach, pairs);
  int count = pairs.count;
  for (int w = 0; w < scene.walls.count && !is_fixed; ++w) {
    WallFeature features[WallArrays::maximum_features];
    const int found = wall_features(scene, a, scene.walls.walls(w), features);
    for (int k = 0; k < found; ++k, ++count)
      if (count < room) row[count] = {static_cast<int>(a), -1 - w, k};
  }
  return count;
}

/// Let the key at parent sink in a heap of so many keys.
KOKKOS_INLINE_FUNCTION void sink(ContactKey* heap, int parent, int count) {
  const ContactKey key = heap[parent];
  for (int child = 2 * parent + 1; child < count; child = 2 * parent + 1) {
    if (child + 1 < count && comes_before(heap[child], heap[child + 1])) ++child;
    if (!comes_before(key, heap[child])) break;
    heap[parent] = heap[child];
    parent = child;
  }
  heap[parent] = key;
}

/// Heapsort: in place, and n log n even for a particle that many others touch.
KOKKOS_INLINE_FUNCTION void sort_row(ContactKey* row, int count) {
  for (int n = count / 2 - 1; n >= 0; --n) sink(row, n, count);
  for (int n = count - 1; n > 0; --n) {
    const ContactKey last = row[n];
    row[n] = row[0];
    row[0] = last;
    sink(row, 0, n);
  }
}

/// Keys per particle that the first search keeps; a particle with more contacts searches again.
constexpr int kept_keys = 16;

void count_contacts(const ContactScene& scene, const CellList& cells, const Array<Index>& sizes,
                    const Array<ContactKey>& kept) {
  for_each(
      "dem::count_contacts", scene.particles.count, KOKKOS_LAMBDA(Index a) {
        sizes(a) = collect_row(scene, cells, a, kept.data() + kept_keys * a, kept_keys);
      });
}

Index sum_row_sizes(Index rows, const Array<Index>& sizes, const Array<Index>& begin) {
  return exclusive_sum("dem::sum_row_sizes", rows, begin, KOKKOS_LAMBDA(Index n) { return sizes(n); });
}

void fill_rows(const ContactScene& scene, const CellList& cells, const Array<ContactKey>& kept,
               const ContactKeys& keys) {
  for_each(
      "dem::fill_rows", scene.particles.count, KOKKOS_LAMBDA(Index a) {
        const Index begin = keys.row_begin(a);
        const int size = static_cast<int>(keys.row_begin(a + 1) - begin);
        ContactKey* row = keys.keys.data() + begin;
        if (size > kept_keys)
          collect_row(scene, cells, a, row, size);
        else
          for (int n = 0; n < size; ++n) row[n] = kept(kept_keys * a + n);
        sort_row(row, size);
      });
}

KOKKOS_INLINE_FUNCTION void set_pair(const ContactScene& scene, const ContactKey& key, Contact& c) {
  const Real radius_a = radius_of(scene, key.a), radius_b = radius_of(scene, key.b);
  c.offset = shift_of(scene.domain, key.image);
  c.reach = radius_a + radius_b;
  c.share = radius_a / c.reach;
  const Vec3 d = scene.particles.position(key.a) - scene.particles.position(key.b) - c.offset;
  c.normal = normalized(d);
  c.gap = norm(d) - c.reach;
  c.material = scene.materials(scene.particles.material(key.a), scene.particles.material(key.b));
}

KOKKOS_INLINE_FUNCTION void set_wall(const ContactScene& scene, const ContactKey& key, Contact& c) {
  const Wall& wall = scene.walls.walls(-1 - key.b);
  WallFeature features[WallArrays::maximum_features];
  wall_features(scene, key.a, wall, features);
  const WallFeature& feature = features[key.image];
  c.offset = feature.point + scene.dt * feature.velocity;
  c.normal = feature.normal;
  c.wall_velocity = feature.velocity;
  c.reach = radius_of(scene, key.a);
  c.share = 1;
  c.gap = dot(c.normal, scene.particles.position(key.a) - feature.point) - c.reach;
  c.material = wall.material_id == Wall::of_own_material
                   ? wall.own_material
                   : scene.materials(scene.particles.material(key.a), wall.material_id);
}

void write_contacts(const ContactScene& scene, const ContactKeys& keys, const Array<Index>& place,
                    const ContactHistory& history, const Array<Contact>& contacts) {
  for_each(
      "dem::write_contacts", keys.count, KOKKOS_LAMBDA(Index n) {
        const ContactKey key = keys.keys(n);
        Contact c;
        c.a = key.a;
        c.b = key.b;
        c.row_entry = static_cast<int>(n);
        if (key.b >= 0)
          set_pair(scene, key, c);
        else
          set_wall(scene, key, c);
        recall(history, key, c);
        contacts(place(n)) = c;
      });
}

}  // namespace

void ContactFinder::find(ContactScene& scene, const Bodies& bodies, ContactKeys& keys) {
  const Index count = scene.particles.count;
  make_room(reaches_, "dem.reaches", count);
  scene.reaches = reaches_;
  compute_reaches(scene, bodies);
  const CellList& cells = search_.sort(count, scene.particles.position, reaches_, scene.domain);

  keys.rows = count;
  make_room(row_sizes_, "dem.row_sizes", count);
  make_room(keys.row_begin, "dem.row_begin", count + 1);
  make_room(kept_, "dem.kept_keys", kept_keys * count);
  count_contacts(scene, cells, row_sizes_, kept_);
  keys.count = sum_row_sizes(count, row_sizes_, keys.row_begin);
  require_state(keys.count <= std::numeric_limits<int>::max(),
                "contacts: expected at most 2147483647, found more");
  make_room(keys.keys, "dem.keys", keys.count);
  fill_rows(scene, cells, kept_, keys);
}

void build_contacts(const ContactScene& scene, const ContactKeys& keys, const Array<Index>& place,
                    const ContactHistory& history, Array<Contact>& contacts) {
  make_room(contacts, "dem.contacts", keys.count);
  write_contacts(scene, keys, place, history, contacts);
}

}  // namespace peclet::dem
