#pragma once
// The solid bodies that the fluid sees: signed distance of every instance of a scene, with its periodic
// images, and the rigid motion of its surface.
#include <vector>

#include "core/halo.hpp"
#include "core/rigid_body.hpp"
#include "core/scene.hpp"
#include "core/scene_program.hpp"

namespace peclet::flow {

/// One instance as kernels need it. Lengths in scene units, velocities per unit time.
struct Body {
  int slot = 0;
  Pose pose;
  Twist twist;                 // at the end of the step
  Twist mean_twist;            // over the step, see Bodies::average_twists()
  Vec3 center;                 // of rotation
  Vec3 middle, lever;          // of the bounds, and from the centre (its nearest image) to there
  Vec3 local_low, local_high;  // bounds in the frame of the root
  Vec3 low, high;              // bounds along the axes of the box, relative to the translation
  bool wide = false;           // reaches beyond half a period: images other than the nearest matter
  bool meets_images = false;   // longer than a period
  bool dynamic = false;        // re-sampled at every geometry update
  bool is_cut[3][2] = {};      // reaches further than a cell beyond this side of the box: more than a touch

  KOKKOS_INLINE_FUNCTION bool spins() const { return dot(twist.angular, twist.angular) > 0; }
};

struct Period {
  Vec3 length;  // of the box
  bool axis[3] = {false, false, false};

  /// Nearest periodic image of a difference of two positions.
  KOKKOS_INLINE_FUNCTION Vec3 nearest(Vec3 r) const {
    constexpr Real surely_nearest = 0.49;
    for (int a = 0; a < 3; ++a)
      if (axis[a] && !(Kokkos::abs(r[a]) < surely_nearest * length[a]))
        r[a] -= length[a] * Kokkos::floor(r[a] / length[a] + 0.5);
    return r;
  }
};

/// Owners of cells: instances count from 0.
inline constexpr int no_owner = -1;
inline constexpr int sampled_solid = -2;  // the solid given as an array of distances

/// Which motion of a body.
enum class Motion { AtEnd, Mean };  // of the step

/// Distance to bodies, callable in kernels.
struct BodyGeometry {
  SceneProgram program;
  Array<Body> bodies;
  Period images;  // of the scene: all false when the scene is not periodic
  Period box;     // of the domain: arms of rotation use it

  /// Signed distance of body b (negative inside), smallest over its periodic images.
  KOKKOS_FORCEINLINE_FUNCTION Real distance(int b, Vec3 x) const {
    const Body& body = bodies(b);
    return distance_from(body, sphere_radius(body), x);
  }

  /// Radius of a sphere whose nearest image is all that matters, else 0.
  KOKKOS_FORCEINLINE_FUNCTION Real sphere_radius(const Body& body) const {
    return body.wide ? 0.0 : body.pose.scale * program.sphere_radius(body.slot);
  }

  /// From the centre of body b to x, nearest image.
  KOKKOS_FORCEINLINE_FUNCTION Vec3 arm(int b, Vec3 x) const {
    return images.nearest(x - bodies(b).pose.translation);
  }

  /// radius: sphere_radius(body).
  KOKKOS_FORCEINLINE_FUNCTION Real distance_from(const Body& body, Real radius, Vec3 x) const {
    const Vec3 center = body.pose.translation, near = center + images.nearest(x - center);
    return radius > 0 ? norm(near - center) - radius : distance_of_shape(body, near);
  }

  KOKKOS_FUNCTION Real distance_of_shape(const Body& body, const Vec3& near) const {
    if (body.pose.scale == 0) return far_away;
    Real d = program.distance(body.slot, body.pose, near);
    if (body.wide && !is_nearest_image(body, near, d)) d = distance_with_images(body, near, d);
    return d;
  }

  /// No other image can be nearer than d.
  KOKKOS_INLINE_FUNCTION bool is_nearest_image(const Body& body, Vec3 x, Real d) const {
    for (int a = 0; a < 3; ++a) {
      if (!images.axis[a]) continue;
      const Real arm = x[a] - body.pose.translation[a];
      const Real beyond_high = arm + images.length[a] - body.high[a];
      const Real beyond_low = body.low[a] - arm + images.length[a];
      const Real gap = beyond_high < beyond_low ? beyond_high : beyond_low;
      if (gap <= 0 || gap < d) return false;
    }
    return true;
  }

  /// From the centre of rotation of body b to its point at x: that of the image of the body nearest to x.
  KOKKOS_INLINE_FUNCTION Vec3 lever(int b, Vec3 x) const {
    const Body& body = bodies(b);
    return body.lever + box.nearest(x - body.middle);
  }

  /// Velocity of the surface of body b at x: U + Omega x lever.
  KOKKOS_INLINE_FUNCTION Vec3 velocity(int b, Vec3 x, Motion motion = Motion::AtEnd) const {
    const Twist& twist = motion == Motion::AtEnd ? bodies(b).twist : bodies(b).mean_twist;
    return twist.linear + cross(twist.angular, lever(b, x));
  }

  KOKKOS_INLINE_FUNCTION Real distance_with_images(const Body& body, Vec3 x, Real nearest_image) const {
    Real d = nearest_image;
    for (int n = 0; n < 27; ++n) {
      const int s[3] = {n % 3 - 1, (n / 3) % 3 - 1, n / 9 - 1};
      if (n == 13 || (s[0] && !images.axis[0]) || (s[1] && !images.axis[1]) || (s[2] && !images.axis[2]))
        continue;
      const Vec3 image = x + Vec3{s[0] * images.length.x, s[1] * images.length.y, s[2] * images.length.z};
      const Vec3 local = to_local(body.pose, image);
      const Real lower = body.pose.scale * distance_to_bounds(body, local);
      if (lower > 0 && lower >= d) continue;  // the image is at least that far away
      const Real candidate = body.pose.scale * program.distance(body.slot, local);
      d = candidate < d ? candidate : d;
    }
    return d;
  }

  KOKKOS_INLINE_FUNCTION static Real distance_to_bounds(const Body& body, Vec3 local) {
    Vec3 outside;
    for (int a = 0; a < 3; ++a) {
      const Real below = body.local_low[a] - local[a], above = local[a] - body.local_high[a];
      const Real gap = below > above ? below : above;
      outside[a] = gap > 0 ? gap : 0;
    }
    return norm(outside);
  }
};

/// What changes of a body while a flow runs.
struct BodyMotion {
  Pose pose;
  Twist twist, former_twist;  // former: at the end of the last step
  Vec3 center;
  bool pinned = false, dynamic = false;

  bool operator==(const BodyMotion& other) const;
};

/// Host side: owns the instances, moves them, and hands a BodyGeometry to kernels.
class Bodies {
 public:
  Bodies() = default;
  Bodies(const Scene& scene, const Grid& grid, bool periodic_images, const Periodicity& domain);

  int count() const { return static_cast<int>(bodies_.size()); }
  const Body& operator[](int b) const { return bodies_[static_cast<std::size_t>(b)]; }
  bool center_pinned(int b) const { return pinned_[static_cast<std::size_t>(b)]; }
  bool moves(int b) const;
  bool any_moves() const;
  bool any_dynamic() const;
  /// Smallest extent of the bounds of body b, over the spacing in that direction; infinite if it vanished.
  Real thickness(int b) const;
  /// Largest of sum |u_a| / h_a over the corners of the bounds of all bodies.
  Real largest_courant_rate() const;

  void set_pose(int b, Vec3 translation, Quaternion rotation);
  /// Largest displacement of a point of body b on the way to a pose.
  Real displacement(int b, Vec3 translation, Quaternion rotation);
  void set_twist(int b, Twist twist);
  /// Some body has another twist than at the end of the last step.
  bool any_accelerates() const;
  /// Mean twists of the step := former twist + weight (twist - former twist).
  void average_twists(Real weight);
  /// A step is over: former twist := twist.
  void end_step();
  void pin_center(int b, Vec3 center);
  void set_dynamic(int b);
  /// All of one body's motion at once, as a checkpoint holds it.
  void restore(int b, const BodyMotion& motion);
  BodyMotion motion(int b) const;
  /// Which sides of the box are periodic.
  void set_domain(const Periodicity& domain);

  /// Device copy of the present state.
  const BodyGeometry& geometry();
  /// Cells whose geometry body b can influence, grown by margin cells; unwrapped along periodic axes
  /// (low may be negative) and clipped along the others. Empty when the body vanished.
  Box region(int b, int margin) const;

 private:
  /// What follows from pose and centre.
  void place(Body& body) const;

  Grid grid_;
  BodyGeometry geometry_;
  std::vector<Body> bodies_;
  std::vector<Twist> former_twists_;
  std::vector<bool> pinned_;
  bool periodic_images_ = false, stale_ = true;
};

/// Signed distance and nearest body of every cell, from all bodies and, where allocated, the samples.
void sample_all_bodies(const Grid& grid, const BodyGeometry& geometry, int count, const Field<Real>& samples,
                       const Field<Real>& distance, const Field<int>& owner);

/// Cells outside every unshifted body that a shifted periodic image of one makes solid.
Index count_image_overlap(const Grid& grid, const BodyGeometry& geometry, int count);

}  // namespace peclet::flow
