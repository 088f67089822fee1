#include "flow/bodies.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/error.hpp"

namespace peclet::flow {
namespace {

Period period_of(const Grid& grid, const Periodicity& periodic) {
  Period period;
  for (int a = 0; a < 3; ++a) {
    period.length[a] = grid.extent(a);
    period.axis[a] = periodic.axis[a];
  }
  return period;
}

void bound(Body& body) {
  body.low = {far_away, far_away, far_away};
  body.high = -body.low;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 local{corner & 1 ? body.local_high.x : body.local_low.x,
                     corner & 2 ? body.local_high.y : body.local_low.y,
                     corner & 4 ? body.local_high.z : body.local_low.z};
    const Vec3 arm = body.pose.scale * rotate(body.pose.rotation, local);
    for (int a = 0; a < 3; ++a) {
      body.low[a] = std::min(body.low[a], arm[a]);
      body.high[a] = std::max(body.high[a], arm[a]);
    }
  }
}

bool is_at_rest(const Twist& twist) {
  return dot(twist.linear, twist.linear) == 0 && dot(twist.angular, twist.angular) == 0;
}

bool same(Vec3 a, Vec3 b) { return a.x == b.x && a.y == b.y && a.z == b.z; }
bool same(const Twist& a, const Twist& b) { return same(a.linear, b.linear) && same(a.angular, b.angular); }

}  // namespace

Bodies::Bodies(const Scene& scene, const Grid& grid, bool periodic_images, const Periodicity& domain)
    : grid_(grid), periodic_images_(periodic_images) {
  std::vector<int> roots;
  for (const SceneInstance& instance : scene.instances()) {
    const auto found = std::find(roots.begin(), roots.end(), instance.root);
    Body body;
    body.slot = static_cast<int>(found - roots.begin());
    if (found == roots.end()) roots.push_back(instance.root);
    body.pose = instance.pose;
    body.twist = body.mean_twist = instance.twist;
    body.center = instance.center_pinned ? instance.center : instance.pose.translation;
    const Scene::Bounds bounds = scene.bounds(instance.root);
    body.local_low = bounds.low;
    body.local_high = bounds.high;
    body.dynamic = !is_at_rest(instance.twist);
    bodies_.push_back(body);
    former_twists_.push_back(instance.twist);
    pinned_.push_back(instance.center_pinned);
  }
  geometry_.program = SceneProgram(scene, roots);
  set_domain(domain);
  geometry_.bodies = Array<Body>("flow::bodies", bodies_.size());
}

void Bodies::set_domain(const Periodicity& domain) {
  geometry_.box = period_of(grid_, domain);
  geometry_.images = geometry_.box;
  for (int a = 0; a < 3; ++a) geometry_.images.axis[a] = geometry_.images.axis[a] && periodic_images_;
  for (Body& body : bodies_) place(body);
  stale_ = true;
}

void Bodies::place(Body& body) const {
  bound(body);
  body.middle = body.pose.translation + 0.5 * (body.low + body.high);
  body.lever = geometry_.box.nearest(body.middle - body.center);
  body.wide = body.meets_images = false;
  for (int a = 0; a < 3; ++a) {
    const Real low = body.pose.translation[a] + body.low[a] - grid_.origin[a];
    const Real high = body.pose.translation[a] + body.high[a] - grid_.origin[a];
    body.is_cut[a][0] = low < -grid_.spacing[a];
    body.is_cut[a][1] = high > grid_.extent(a) + grid_.spacing[a];
    if (!geometry_.images.axis[a]) continue;
    // a band around the surface must see the true distance through the nearest image alone
    const Real reach = std::max(-body.low[a], body.high[a]) + 4 * grid_.spacing[a];
    body.wide = body.wide || reach > 0.5 * grid_.extent(a);
    body.meets_images = body.meets_images || body.high[a] - body.low[a] > grid_.extent(a);
  }
}

bool Bodies::moves(int b) const { return !is_at_rest((*this)[b].twist); }

bool Bodies::any_moves() const {
  for (int b = 0; b < count(); ++b)
    if (moves(b)) return true;
  return false;
}

bool Bodies::any_dynamic() const {
  return std::any_of(bodies_.begin(), bodies_.end(), [](const Body& body) { return body.dynamic; });
}

Real Bodies::thickness(int b) const {
  const Body& body = (*this)[b];
  Real smallest = std::numeric_limits<Real>::infinity();
  if (body.pose.scale == 0) return smallest;
  for (int a = 0; a < 3; ++a) {
    Vec3 direction;
    direction[a] = 1;
    direction = rotate(body.pose.rotation, direction);
    Vec3 step;
    for (int c = 0; c < 3; ++c) step[c] = direction[c] * grid_.spacing[c];
    smallest = std::min(smallest, body.pose.scale * (body.local_high[a] - body.local_low[a]) / norm(step));
  }
  return smallest;
}

Real Bodies::largest_courant_rate() const {
  Real largest = 0;
  for (const Body& body : bodies_)
    for (int corner = 0; corner < 8; ++corner) {
      Vec3 arm = body.lever;
      for (int a = 0; a < 3; ++a) arm[a] += (corner >> a & 1 ? 0.5 : -0.5) * (body.high[a] - body.low[a]);
      const Vec3 velocity = body.twist.linear + cross(body.twist.angular, arm);
      Real rate = 0;
      for (int a = 0; a < 3; ++a) rate += std::abs(velocity[a]) / grid_.spacing[a];
      largest = std::max(largest, rate);
    }
  return largest;
}

void Bodies::set_pose(int b, Vec3 translation, Quaternion rotation) {
  const auto n = static_cast<std::size_t>(b);
  bodies_[n].pose.translation = translation;
  bodies_[n].pose.rotation = normalized(rotation);
  if (!pinned_[n]) bodies_[n].center = translation;
  place(bodies_[n]);
  stale_ = true;
}

Real Bodies::displacement(int b, Vec3 translation, Quaternion rotation) {
  const Body& body = (*this)[b];
  const Quaternion turned = normalized(rotation);
  const Vec3 shift = geometry().box.nearest(translation - body.pose.translation);
  Real largest = 0;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 x;
    for (int a = 0; a < 3; ++a)
      x[a] = body.pose.scale * ((corner >> a) & 1 ? body.local_high : body.local_low)[a];
    largest = std::max(largest, norm(shift + (rotate(turned, x) - rotate(body.pose.rotation, x))));
  }
  return largest;
}

void Bodies::set_twist(int b, Twist twist) {
  bodies_[static_cast<std::size_t>(b)].twist = twist;
  stale_ = true;
}

bool Bodies::any_accelerates() const {
  for (std::size_t b = 0; b < bodies_.size(); ++b)
    if (!same(bodies_[b].twist, former_twists_[b])) return true;
  return false;
}

void Bodies::average_twists(Real weight) {
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    const Twist &now = bodies_[b].twist, &former = former_twists_[b];
    const Real past = 1 - weight;
    const Twist mean{now.linear + past * (former.linear - now.linear),
                     now.angular + past * (former.angular - now.angular)};
    if (same(mean, bodies_[b].mean_twist)) continue;
    bodies_[b].mean_twist = mean;
    stale_ = true;
  }
}

void Bodies::end_step() {
  for (std::size_t b = 0; b < bodies_.size(); ++b) former_twists_[b] = bodies_[b].twist;
}

void Bodies::pin_center(int b, Vec3 center) {
  Body& body = bodies_[static_cast<std::size_t>(b)];
  body.center = center;
  pinned_[static_cast<std::size_t>(b)] = true;
  place(body);
  stale_ = true;
}

void Bodies::set_dynamic(int b) {
  bodies_[static_cast<std::size_t>(b)].dynamic = true;
  stale_ = true;
}

bool BodyMotion::operator==(const BodyMotion& other) const {
  const Quaternion q = pose.rotation, r = other.pose.rotation;
  return same(pose.translation, other.pose.translation) && q.x == r.x && q.y == r.y && q.z == r.z &&
         q.w == r.w && pose.scale == other.pose.scale && same(twist, other.twist) &&
         same(former_twist, other.former_twist) && same(center, other.center) && pinned == other.pinned &&
         dynamic == other.dynamic;
}

BodyMotion Bodies::motion(int b) const {
  const Body& body = (*this)[b];
  return {body.pose,   body.twist,       former_twists_[static_cast<std::size_t>(b)],
          body.center, center_pinned(b), body.dynamic};
}

void Bodies::restore(int b, const BodyMotion& motion) {
  const auto n = static_cast<std::size_t>(b);
  Body& body = bodies_[n];
  body.pose = motion.pose;
  body.twist = body.mean_twist = motion.twist;
  former_twists_[n] = motion.former_twist;
  body.center = motion.center;
  body.dynamic = motion.dynamic;
  pinned_[n] = motion.pinned;
  place(body);
  stale_ = true;
}

const BodyGeometry& Bodies::geometry() {
  if (stale_) {
    const Kokkos::View<const Body*, Kokkos::HostSpace, Kokkos::MemoryTraits<Kokkos::Unmanaged>> host(
        bodies_.data(), bodies_.size());
    Kokkos::deep_copy(geometry_.bodies, host);
    stale_ = false;
  }
  return geometry_;
}

Box Bodies::region(int b, int margin) const {
  const Body& body = (*this)[b];
  Box region;
  if (body.pose.scale == 0) return region;
  const Vec3 start = body.pose.translation - Vec3{grid_.origin[0], grid_.origin[1], grid_.origin[2]};
  for (int a = 0; a < 3; ++a) {
    const Real h = grid_.spacing[a];
    const int n = grid_.cells[a];
    const Real first = std::floor((start[a] + body.low[a]) / h) - margin;
    const Real last = std::ceil((start[a] + body.high[a]) / h) + margin;
    if (geometry_.images.axis[a]) {
      if (last - first >= n) {
        region.low[a] = 0;
        region.high[a] = n;
      } else {
        const Real shift = n * std::floor(first / n);
        region.low[a] = static_cast<int>(first - shift);
        region.high[a] = static_cast<int>(last - shift);
      }
    } else {
      region.low[a] = static_cast<int>(std::clamp(first, 0.0, static_cast<Real>(n)));
      region.high[a] = static_cast<int>(std::clamp(last, 0.0, static_cast<Real>(n)));
    }
  }
  if (region.extent(0) <= 0 || region.extent(1) <= 0 || region.extent(2) <= 0) return Box{};
  return region;
}

void sample_all_bodies(const Grid& grid, const BodyGeometry& geometry, int count, const Field<Real>& samples,
                       const Field<Real>& distance, const Field<int>& owner) {
  const Field<Real> result = distance, given = samples;
  const Field<int> nearest = owner;
  const BodyGeometry bodies = geometry;
  const bool sampled = samples.is_allocated();
  for_each_cell(
      "flow::sample_all_bodies", RowRanges(grid.cells), KOKKOS_LAMBDA(int i, int j, int k) {
        Real smallest = sampled ? given(i, j, k) : far_away;
        int body = sampled ? sampled_solid : no_owner;
        for (int b = 0; b < count; ++b) {
          const Real d = bodies.distance(b, grid.cell_center(i, j, k));
          if (d >= smallest) continue;
          smallest = d;
          body = b;
        }
        result(i, j, k) = smallest;
        nearest(i, j, k) = body;
      });
}

Index count_image_overlap(const Grid& grid, const BodyGeometry& geometry, int count) {
  const BodyGeometry bodies = geometry;
  return static_cast<Index>(sum_cells(
      "flow::count_image_overlap", RowRanges(grid.cells), KOKKOS_LAMBDA(int i, int j, int k) {
        const Vec3 x = grid.cell_center(i, j, k);
        bool solid = false, unshifted = false;
        for (int b = 0; b < count; ++b) {
          const Body& body = bodies.bodies(b);
          solid = solid || bodies.distance(b, x) < 0;
          // a body that fits into the box has no image of its own to collide with
          const Real alone =
              body.meets_images ? bodies.program.distance(body.slot, body.pose, x) : bodies.distance(b, x);
          unshifted = unshifted || alone < 0;
        }
        return solid && !unshifted ? 1.0 : 0.0;
      }));
}

}  // namespace peclet::flow
