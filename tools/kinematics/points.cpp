#include "tools/kinematics/points.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>

#include "tools/bench/detector.h"
#include "tools/bench/ego_motion_feed.h"
#include "tools/scoring/statistics.h"

namespace lcs::kinematics {
namespace {

constexpr double kNearest_m = 0.05;  // in front of the camera; nearer points are not in the image

bool in_image(const sim::Pinhole& camera, const Vec2& px) {
  // The comparisons are false for NaN.
  return px.x() >= -0.5 && px.y() >= -0.5 && px.x() <= camera.width_px - 0.5 &&
         px.y() <= camera.height_px - 0.5;
}

Vec2 whole(const Vec2& px) {
  return {std::round(px.x()), std::round(px.y())};
}

/// Z_ref / Z from the whole-pixel sightings of a point that reached `p_C` in equal steps.
double learnt_ratio(const sim::Pinhole& camera, const MotionField& field, const Site& site,
                    const Eigen::Vector3d& displacement_C_m) {
  const Eigen::Vector3d p_C = camera.back_project(site.px, site.depth_m);
  for (int steps = kLearningSteps; steps > 0; --steps) {
    const Eigen::Vector3d travelled_C = steps * displacement_C_m;
    const Eigen::Vector3d first_C = p_C + travelled_C;
    if (first_C.z() < kNearest_m) continue;
    const Vec2 first = camera.project(first_C);
    if (in_image(camera, first)) {
      return ratio_from(camera, field, whole(site.px), whole(first), travelled_C);
    }
  }
  return 1;
}

}  // namespace

const char* name(RotationModel rotation) {
  return rotation == RotationModel::as_printed    ? "as_printed"
         : rotation == RotationModel::first_order ? "first_order"
                                                  : "homography";
}

const char* name(DepthSource depth) {
  return depth == DepthSource::reference ? "reference"
         : depth == DepthSource::learnt  ? "learnt"
                                         : "truth";
}

ErrorSummary summary(std::vector<double> errors_px) {
  if (errors_px.empty()) return {};
  double squares = 0;
  for (const double error : errors_px) squares += error * error;
  return {.count = errors_px.size(),
          .median_px = *scoring::median(errors_px),
          .p95_px = *scoring::quantile(errors_px, 0.95),
          .max_px = *std::ranges::max_element(errors_px),
          .rms_px = std::sqrt(squares / static_cast<double>(errors_px.size()))};
}

std::vector<double> errors(const FieldStep& step, const FieldModel& model,
                           const std::vector<Landmark>& landmarks) {
  FieldParameters parameters = step.field;
  parameters.rotation = model.rotation;
  const MotionField field(step.camera, step.motion, parameters);
  std::vector<double> all;
  for (const Landmark& landmark : landmarks) {
    // The field takes the ratio at the end of the interval; the learnt one is from its start.
    const double ratio = model.depth == DepthSource::reference ? 1
                         : model.depth == DepthSource::learnt
                             ? field.advanced_ratio(landmark.learnt_ratio)
                             : field.reference_depth_m() / landmark.depth_after_m;
    const Vec2 predicted_px = field.translated(field.rotated(landmark.before_px), ratio);
    all.push_back((predicted_px - landmark.after_px).norm());
  }
  return all;
}

double ratio_from(const sim::Pinhole& camera, const MotionField& field, const Vec2& now_px,
                  const Vec2& before_px, const Eigen::Vector3d& displacement_C_m) {
  // before = (now + w K d) / (1 + w d_z)  =>  w (K d_xy + (c - before) d_z) = before - now
  const Vec2 parallax = camera.focal_px * displacement_C_m.head<2>() +
                        (camera.centre_px - before_px) * displacement_C_m.z();
  const double length2 = parallax.squaredNorm();
  if (length2 < 1e-12) return 0;
  const double w = (before_px - now_px).dot(parallax) / length2;
  return std::clamp(w * field.reference_depth_m(), 0.0, field.max_ratio());
}

PointSet geometric_points(const sim::Pinhole& camera, std::span<const double> depths_m, int columns,
                          int rows) {
  PointSet set{"geometric", camera, {}, {}};
  for (const double depth_m : depths_m) {
    for (int row = 0; row < rows; ++row) {
      for (int column = 0; column < columns; ++column) {
        set.sites.push_back({{(camera.width_px - 1.0) * column / (columns - 1),
                              (camera.height_px - 1.0) * row / (rows - 1)},
                             depth_m});
      }
    }
  }
  set.seen_from = [camera, sites = set.sites](const sim::Pose& T_CN) {
    const sim::Pose T_NC = T_CN.inverse();
    std::vector<Vec2> seen;
    for (const Site& site : sites) {
      const Eigen::Vector3d p_N = T_NC * camera.back_project(site.px, site.depth_m);
      seen.push_back(p_N.z() > kNearest_m ? camera.project(p_N) : Vec2::Constant(std::nan("")));
    }
    return seen;
  };
  return set;
}

PointSet rendered_points(const sim::Pinhole& camera, sim::FrameTruth truth,
                         const std::vector<Eigen::Vector2f>& corners_px) {
  PointSet set{"rendered", camera, {}, {}};
  std::vector<Eigen::Vector2f> fixed;
  const auto labels = sim::label_corners(camera, truth, corners_px, 1);
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    if (labels[i].label != sim::Label::fixed || labels[i].depth_m < kNearest_m) continue;
    fixed.push_back(corners_px[i]);
    set.sites.push_back({corners_px[i].cast<double>(), labels[i].depth_m});
  }
  set.seen_from = [camera, truth = std::make_shared<sim::FrameTruth>(std::move(truth)),
                   corners = std::move(fixed)](const sim::Pose& T_CN) {
    truth->next.T_WC = truth->now.T_WC * T_CN;
    std::vector<Vec2> seen;
    const auto moved = sim::label_corners(camera, *truth, corners, 1);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      seen.push_back(corners[i].cast<double>() + moved[i].static_motion_px);
    }
    return seen;
  };
  return set;
}

std::vector<Landmark> landmarks(const PointSet& points, const sim::Pose& T_CN,
                                const FieldParameters& field) {
  const std::vector<Vec2> after = points.seen_from(T_CN);
  const sim::Pose T_NC = T_CN.inverse();
  const MotionField learning(bench::intrinsics(points.camera), {}, field);
  std::vector<Landmark> seen;
  for (std::size_t i = 0; i < after.size(); ++i) {
    const Site& site = points.sites[i];
    const double depth_after_m = (T_NC * points.camera.back_project(site.px, site.depth_m)).z();
    if (depth_after_m < kNearest_m || !in_image(points.camera, after[i])) continue;
    seen.push_back({.before_px = site.px,
                    .after_px = after[i],
                    .depth_after_m = depth_after_m,
                    .learnt_ratio = learnt_ratio(points.camera, learning, site, T_CN.p)});
  }
  return seen;
}

FieldStep step_to(const sim::Pinhole& camera, const sim::Pose& T_CN, double dt_s,
                  const FieldParameters& field) {
  return {bench::intrinsics(camera), bench::motion_between({}, T_CN, dt_s), field};
}

sim::Pose turned(int axis, double angle_rad, const Eigen::Vector3d& displacement_C_m) {
  return {Eigen::AngleAxisd(angle_rad, Eigen::Vector3d::Unit(axis)).toRotationMatrix(),
          displacement_C_m};
}

}  // namespace lcs::kinematics
