/// \file
/// Normal edges in the terms of a known ground.
#pragma once

#include <cmath>

#include "filter/circles/circle_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/types/layers.h"

namespace lcs {

/// The ground's directions in the picture, and coordinates of rays by it. Needs a ground, and a
/// camera that does not look straight down.
class GroundView {
 public:
  GroundView(const Intrinsics& camera, const MotionField& field)
      : camera_(camera),
        ground_(*field.ground()),
        across_(Vec2(-ground_.up_C.y(), ground_.up_C.x()).normalized()),
        slack_pm_(field.ground_slack() / field.reference_depth_m()) {}

  /// Fall of the ray of a place, per unit of depth.
  double down(const Vec2& x_px) const {
    return ground_.height_m * ground_.inverse_depth_pm(ray(x_px));
  }
  /// The same to the right.
  double along(const Vec2& x_px) const { return across_.dot(ray(x_px)); }
  /// 1/m: inverse depth of the ground where rays fall by `down`.
  double ground_pm(double down) const { return down / ground_.height_m; }
  /// 1/m: standard deviation of it, by the ground's tilt.
  double slack_pm() const { return slack_pm_; }
  /// `down` of the ground at this inverse depth.
  double ground_down(double inverse_depth_pm) const { return inverse_depth_pm * ground_.height_m; }
  /// Largest `down` in the picture, in its middle column.
  double lowest() const {
    return down({camera_.centre_px.x(), static_cast<double>(camera_.height_px - 1)});
  }

  /// Unit vector of the picture along the horizon.
  const Vec2& across() const { return across_; }
  /// Place of a ray, px.
  Vec2 place_px(double along, double down) const {
    const Vec2 up = ground_.up_C.head<2>();
    const double upward = -(down + ground_.up_C.z()) / up.norm();
    return camera_.centre_px + camera_.focal_px * (along * across_ + upward * up.normalized());
  }
  /// px per unit of `down`.
  double px_per_down() const { return camera_.focal_px / ground_.up_C.head<2>().norm(); }

 private:
  Vec2 ray(const Vec2& x_px) const { return (x_px - camera_.centre_px) / camera_.focal_px; }

  const Intrinsics& camera_;
  Ground ground_;
  Vec2 across_;
  double slack_pm_;
};

/// A normal edge by that view.
struct GroundEdge {
  GroundEdge(const Edge& edge, const GroundView& view, const MotionField& field,
             const CircleParameters& circle)
      : inverse_depth_pm(edge.depth_ratio / field.reference_depth_m()),
        sigma_pm(edge.depth_ratio_sigma / field.reference_depth_m()),
        down(view.down(edge.location)),
        along(view.along(edge.location)),
        is_seen(edge.corner >= 0 && std::isfinite(sigma_pm)) {
    const double ground_pm = view.ground_pm(down);
    const Eigen::Vector3d sigmas(sigma_pm, view.slack_pm(), circle.roughness * ground_pm);
    is_ground = std::abs(inverse_depth_pm - ground_pm) < 2 * sigmas.norm();
  }

  double inverse_depth_pm, sigma_pm;
  double down, along;
  bool is_seen;    ///< it has a corner in this frame, and a depth
  bool is_ground;  ///< it may be a point of the ground
};

}  // namespace lcs
