/// \file
/// A world of points for tests of the filter: fixed and moving points, a camera, exact projections.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <optional>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/kinematics/geometry.h"
#include "filter/kinematics/motion_field.h"
#include "filter/types/signature.h"

namespace lcs::testing {

/// Small repeatable generator (splitmix64): the same numbers with every standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform(double low, double high) {
    state_ += 0x9e3779b97f4a7c15ULL;
    std::uint64_t z = state_;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9ULL;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebULL;
    z ^= z >> 31;
    return low + (high - low) * static_cast<double>(z >> 11) * 0x1.0p-53;
  }
  Eigen::Vector3d vector(double half_width) {
    const double x = uniform(-half_width, half_width), y = uniform(-half_width, half_width);
    return {x, y, uniform(-half_width, half_width)};
  }

 private:
  std::uint64_t state_;
};

inline Intrinsics vga() {
  return {415.7, {319.5, 239.5}, 640, 480};
}

inline Eigen::Matrix3d rotation(const Eigen::Vector3d& r) {
  return r.norm() > 0 ? Eigen::AngleAxisd(r.norm(), r.normalized()).toRotationMatrix()
                      : Eigen::Matrix3d(Eigen::Matrix3d::Identity());
}

/// Ego-motion with constant velocity and body rate, exact over the interval.
inline EgoMotion steady_motion(const Eigen::Vector3d& v_C, const Eigen::Vector3d& w_C,
                               double dt_s) {
  EgoMotion motion;
  motion.dt_s = dt_s;
  motion.v_C_mps = v_C;
  motion.w_C_radps = w_C;
  motion.R_cur_prev = rotation(-w_C * dt_s);
  return motion;
}

/// The motion field of a camera that moves ahead along its axis at 0.5 m/s, at 10 Hz.
inline MotionField ahead(const std::optional<Ground>& ground = {}) {
  EgoMotion motion = steady_motion({0, 0, 0.5}, Eigen::Vector3d::Zero(), 0.1);
  motion.ground = ground;
  return {vga(), motion, FieldParameters{}};
}

inline Vec2 project(const Intrinsics& camera, const Eigen::Vector3d& x_C) {
  return camera.focal_px * x_C.head<2>() / x_C.z() + camera.centre_px;
}

inline Eigen::Vector3d back_project(const Intrinsics& camera, const Vec2& px, double depth) {
  const Vec2 xy = (px - camera.centre_px) / camera.focal_px * depth;
  return {xy.x(), xy.y(), depth};
}

/// Signature of a point in a frame: its own bits, of which a random tenth is flipped each time.
inline Signature signature_of(std::size_t point, std::uint64_t frame) {
  Random own(point), wrong(1000003 * (frame + 1) + point);
  Signature signature{};
  for (std::uint64_t& word : signature) {
    for (int bit = 0; bit < 64; ++bit) {
      const bool is_set = (own.uniform(0, 1) < 0.5) != (wrong.uniform(0, 1) < 0.1);
      word |= static_cast<std::uint64_t>(is_set) << bit;
    }
  }
  return signature;
}

/// Points in the camera frame, moved along from frame to frame.
struct World {
  struct Point {
    Eigen::Vector3d x_C;                                   ///< m, now
    Eigen::Vector3d velocity_C = Eigen::Vector3d::Zero();  ///< its own, in the camera's axes
  };
  Intrinsics camera = vga();
  std::vector<Point> points;

  void add(const Vec2& px, double depth, const Eigen::Vector3d& velocity_C = {0, 0, 0}) {
    points.push_back({back_project(camera, px, depth), velocity_C});
  }

  /// Moves the camera by `motion`: X(k) = R (X(k-1) + own motion) - displacement.
  void advance(const EgoMotion& motion) {
    for (Point& point : points) {
      point.x_C = motion.R_cur_prev * (point.x_C + point.velocity_C * motion.dt_s) -
                  motion.v_C_mps * motion.dt_s;
      point.velocity_C = motion.R_cur_prev * point.velocity_C;
    }
  }

  /// Images of the points that are in front and inside, px, in the order of the points.
  std::vector<Eigen::Vector2f> corners() const {
    std::vector<Eigen::Vector2f> seen;
    for (const Point& point : points) {
      if (const auto px = image(point)) seen.push_back(px->cast<float>());
    }
    return seen;
  }

  /// Signatures of the same points as `corners`.
  std::vector<Signature> signatures(std::uint64_t frame) const {
    std::vector<Signature> seen;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (image(points[i])) seen.push_back(signature_of(i, frame));
    }
    return seen;
  }

  std::optional<Vec2> image(const Point& point) const {
    if (point.x_C.z() < 0.1) return std::nullopt;
    const Vec2 px = project(camera, point.x_C);
    if (px.x() < 0 || px.y() < 0 || px.x() > camera.width_px - 1 || px.y() > camera.height_px - 1) {
      return std::nullopt;
    }
    return px;
  }
};

/// A static world whose corners are at least `spacing` px apart, at random depths.
inline World sparse_world(std::uint64_t seed, double spacing = 60) {
  World world;
  Random random(seed);
  for (double y = spacing / 2; y < 480; y += spacing) {
    for (double x = spacing / 2; x < 640; x += spacing) {
      const double jitter = spacing / 6;
      world.add({x + random.uniform(-jitter, jitter), y + random.uniform(-jitter, jitter)},
                random.uniform(2, 8));
    }
  }
  return world;
}

/// A crowded world with a moving cluster, and a camera that moves and turns.
struct Scene {
  explicit Scene(std::uint64_t seed) {
    Random random(seed);
    for (int i = 0; i < 150; ++i) {
      world.add({random.uniform(5, 634), random.uniform(5, 474)}, random.uniform(1.5, 8));
    }
    for (int i = 0; i < 20; ++i) {
      world.add({random.uniform(380, 440), random.uniform(180, 240)}, 2.5, {-0.6, 0, 0});
    }
    motion = steady_motion({0.05, 0.02, 0.5}, {0.02, -0.05, 0.03}, 0.1);
  }
  World world;
  EgoMotion motion;
};

/// Corners of `frames` frames of a scene, on a grid of 1/64 px, so that mirrored ones are exact.
inline std::vector<std::vector<Eigen::Vector2f>> record(Scene& scene, int frames) {
  std::vector<std::vector<Eigen::Vector2f>> recorded;
  for (int k = 0; k < frames; ++k) {
    recorded.push_back(scene.world.corners());
    for (auto& x : recorded.back()) x = (64 * x).array().round() / 64;
    scene.world.advance(scene.motion);
  }
  return recorded;
}

}  // namespace lcs::testing
