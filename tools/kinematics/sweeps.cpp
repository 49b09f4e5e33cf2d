#include "tools/kinematics/study.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "tools/kinematics/theory.h"
#include "tools/scoring/statistics.h"

namespace lcs::kinematics {
namespace {

constexpr std::array kAngles_deg = {0.0, 0.1, 0.25, 0.5, 1.0, 1.5, 2.0, 2.5,
                                    3.0, 4.0, 5.0,  6.0, 7.0, 8.0, 9.0, 10.0};
constexpr std::array kSpeeds_mps = {0.03, 0.1, 0.3, 1.0, 3.0, 10.0};
constexpr std::array kRates_hz = {1.0, 3.0, 10.0, 30.0};
constexpr std::array kDepths_m = {1.0, 2.0, 4.0, 8.0, 16.0, 32.0};
constexpr double kMostOfDepth = 0.5;  // largest step over depth; beyond it few points stay in view
constexpr std::array kMount_deg = {0.0, 0.25, 0.5, 1.0, 2.0, 3.0, 4.0, 5.0};
constexpr double kFoeBin_px = 50;
constexpr double kSmallestTurn_rad = 1e-5, kTurnStep = 1.2;  // search for limits

/// Errors of a model on all point sets after a motion to `T_CN`, of which `step` tells the model.
std::vector<double> errors_after(const std::vector<PointSet>& points, const sim::Pose& T_CN,
                                 const FieldStep& step, const FieldModel& model) {
  std::vector<double> all;
  for (const PointSet& set : points) {
    append(all, errors(step, model, landmarks(set, T_CN, step.field)));
  }
  return all;
}

FieldStep step_of(const StudyConfig& config, const sim::Pose& T_CN) {
  return step_to(config.camera, T_CN, config.frame_s(), field_of(config.filter));
}

}  // namespace

const char* axis_name(int axis) {
  return axis == 0 ? "tilt" : axis == 1 ? "pan" : "roll";
}

void sweep_rotation(const StudyConfig& config, const std::vector<PointSet>& points, Table& rows) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double angle_deg : kAngles_deg) {
      for (const bool drives : {false, true}) {
        const Eigen::Vector3d step_C = drives ? config.step_C_m() : Eigen::Vector3d::Zero();
        for (const FieldModel& model : kModels) {
          if (!drives && model.depth != DepthSource::truth) continue;  // depth does not matter
          std::vector<double> all;
          for (const double side : {-1.0, 1.0}) {
            const sim::Pose T_CN = turned(axis, side * angle_deg * kDegree, step_C);
            append(all, errors_after(points, T_CN, step_of(config, T_CN), model));
          }
          rows.add(points.front().name, axis_name(axis), angle_deg, step_C.norm(), model,
                   summary(std::move(all)));
        }
      }
    }
  }
}

double rotation_limit_rad(const PointSet& points, const FieldParameters& field,
                          RotationModel rotation, int axis, double bound_px, double told_sign) {
  const auto worst = [&](double angle) {
    double largest = 0;
    for (const double side : {-1.0, 1.0}) {
      const sim::Pose T_CN = turned(axis, side * angle);
      FieldStep step = step_to(points.camera, T_CN, 1, field);
      step.motion.w_C_radps *= told_sign;
      for (const double error :
           errors(step, {rotation, DepthSource::truth}, landmarks(points, T_CN, field))) {
        largest = std::max(largest, error);
      }
    }
    return largest;
  };
  // Search upwards: after the first crossing the points with the largest errors leave the image.
  double low = 0, high = kSmallestTurn_rad;
  while (worst(high) <= bound_px) {
    low = high;
    high *= kTurnStep;
    if (high > kLargestTurn_rad) return std::nan("");
  }
  while (high - low > 1e-4 * high) {
    const double middle = 0.5 * (low + high);
    (worst(middle) <= bound_px ? low : high) = middle;
  }
  return low;
}

void sweep_translation(const StudyConfig& config, const std::vector<PointSet>& rendered,
                       Table& rows) {
  const auto add = [&](const std::vector<PointSet>& points, double speed, double rate,
                       double depth_m) {
    const double step_m = speed / rate;
    if (step_m / depth_m > kMostOfDepth) return;
    const sim::Pose T_CN{Eigen::Matrix3d::Identity(), step_m * config.forward_C};
    const FieldStep step = step_to(config.camera, T_CN, 1 / rate, field_of(config.filter));
    for (const DepthSource depth : kDepths) {
      rows.add(points.front().name, speed, rate, depth_m, step_m / depth_m, depth,
               summary(errors_after(points, T_CN, step, {RotationModel::homography, depth})));
    }
  };
  std::vector<double> depths_m;
  for (const PointSet& set : rendered) {
    for (const Site& site : set.sites) depths_m.push_back(site.depth_m);
  }
  const auto median_m = scoring::median(depths_m);
  for (const double speed : kSpeeds_mps) {
    for (const double rate : kRates_hz) {
      for (const double depth_m : kDepths_m) {
        add({geometric_points(config.camera, std::array{depth_m})}, speed, rate, depth_m);
      }
      if (median_m) add(rendered, speed, rate, *median_m);
    }
  }
}

void sweep_foe_distance(const StudyConfig& config, const std::vector<PointSet>& points,
                        Table& rows) {
  const sim::Pose T_CN = turned(1, kFoePan_deg * kDegree, config.step_C_m());
  const FieldStep step = step_of(config, T_CN);
  const MotionField field(step.camera, step.motion, step.field);
  std::vector<Landmark> seen;
  for (const PointSet& set : points) {
    append(seen, landmarks(set, T_CN, field_of(config.filter)));
  }
  const double diagonal_px = std::hypot(config.camera.width_px, config.camera.height_px);
  for (double from = 0; from < diagonal_px; from += kFoeBin_px) {
    std::vector<Landmark> there;
    for (const Landmark& landmark : seen) {
      // A focus at infinity is equally far from all points: use the image centre instead.
      const Vec2 focus = field.foe().value_or(config.camera.centre_px);
      const double distance = (field.rotated(landmark.before_px) - focus).norm();
      if (distance >= from && distance < from + kFoeBin_px) there.push_back(landmark);
    }
    if (there.empty()) continue;
    for (const FieldModel& model : kModels) {
      rows.add(points.front().name, from, from + kFoeBin_px, model,
               summary(errors(step, model, there)));
    }
  }
}

EgoMotion seen_by_wrong_mount(const EgoMotion& motion, const Eigen::Matrix3d& R_CM) {
  EgoMotion told = motion;
  told.R_cur_prev = R_CM.transpose() * motion.R_cur_prev * R_CM;
  told.v_C_mps = R_CM.transpose() * motion.v_C_mps;
  told.w_C_radps = R_CM.transpose() * motion.w_C_radps;
  return told;
}

void sweep_mount(const StudyConfig& config, const std::vector<PointSet>& points, Table& rows) {
  for (int axis = 0; axis < 3; ++axis) {
    for (const double error_deg : kMount_deg) {
      for (const double pan_deg : {0.0, kMountPan_deg}) {
        const sim::Pose T_CN = turned(1, pan_deg * kDegree, config.step_C_m());
        FieldStep step = step_of(config, T_CN);
        const auto foe = MotionField(step.camera, step.motion, step.field).foe();
        step.motion = seen_by_wrong_mount(step.motion, turned(axis, error_deg * kDegree).R);
        const auto told_foe = MotionField(step.camera, step.motion, step.field).foe();
        rows.add(points.front().name, axis_name(axis), error_deg, pan_deg,
                 foe && told_foe ? (*told_foe - *foe).norm() : std::nan(""),
                 summary(errors_after(points, T_CN, step, {})));
      }
    }
  }
}

void add_focal_length(const StudyConfig& config, const PointSet& points, double fovy_deg,
                      Table& rows) {
  double limit_deg[3], theory_deg[3], printed_deg[3];
  const FieldParameters& field = field_of(config.filter);
  for (int axis = 0; axis < 3; ++axis) {
    const auto measured_deg = [&](RotationModel rotation) {
      return rotation_limit_rad(points, field, rotation, axis, config.tolerance_px) / kDegree;
    };
    limit_deg[axis] = measured_deg(RotationModel::first_order);
    theory_deg[axis] = first_order_limit_rad(points.camera, axis, config.tolerance_px) / kDegree;
    printed_deg[axis] = measured_deg(RotationModel::as_printed);
  }
  const sim::Pose T_CN{Eigen::Matrix3d::Identity(), config.step_C_m()};
  const FieldStep step = step_to(points.camera, T_CN, config.frame_s(), field);
  const std::vector<Landmark> seen = landmarks(points, T_CN, field);
  const auto median = [&](DepthSource depth) {
    return summary(errors(step, {RotationModel::homography, depth}, seen)).median_px;
  };
  rows.add(points.name, fovy_deg, points.camera.focal_px, limit_deg, theory_deg, printed_deg,
           median(DepthSource::reference), median(DepthSource::learnt));
}

}  // namespace lcs::kinematics
