
#include <Eigen/Geometry>
#include <algorithm>

#include "sim/drive.h"
#include "tools/kinematics/study.h"
#include "tools/kinematics/theory.h"

namespace lcs::kinematics {
namespace {

/// Velocity and body rate of the camera, in C.
struct Motion {
  Eigen::Vector3d v_mps, w_radps;
};

Motion motion_of(const sim::Observation& frame) {
  return {frame.truth.now.T_WC.R.transpose() * frame.truth.v_WC_mps, frame.truth.w_C_radps};
}

sim::Pose T_CN_after(const Motion& motion, double dt_s) {
  const double turn_rad = motion.w_radps.norm() * dt_s;
  sim::Pose T_CN;
  T_CN.p = motion.v_mps * dt_s;
  if (turn_rad != 0) {
    T_CN.R = Eigen::AngleAxisd(turn_rad, motion.w_radps.normalized()).toRotationMatrix();
  }
  return T_CN;
}

/// The way of each point by a motion during `dt_s`, exact and by the motion field.
void add_ways(const PointSet& points, const Motion& motion, double dt_s, std::vector<double>& exact,
              std::vector<double>& field) {
  const std::vector<Vec2> after = points.seen_from(T_CN_after(motion, dt_s));
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!after[i].allFinite()) continue;
    const Site& site = points.sites[i];
    const double focal_px = points.camera.focal_px;
    const Vec2 x_px = site.px - points.camera.centre_px;
    exact.push_back((after[i] - site.px).norm());
    field.push_back((velocity_jacobian(x_px, focal_px, site.depth_m, dt_s) * motion.v_mps +
                     rotation_jacobian(x_px, focal_px) * motion.w_radps * dt_s)
                        .norm());
  }
}

/// A distorted picture's points, taken for points of the pinhole's picture.
void add_distorted(const PointSet& points, const sim::Optics& optics, const sim::Pose& T_CN,
                   std::vector<double>& errors) {
  const sim::Pose T_NC = T_CN.inverse();
  for (const Site& site : points.sites) {
    const Eigen::Vector3d p_C = optics.back_project(site.px, site.depth_m);
    if (!p_C.allFinite()) continue;
    const Eigen::Vector3d p_N = T_NC * p_C;
    const Eigen::Vector3d wrong_N = T_NC * points.camera.back_project(site.px, site.depth_m);
    if (p_N.z() <= 0 || wrong_N.z() <= 0) continue;
    const Vec2 after = optics.project(p_N);
    if (after.allFinite()) errors.push_back((points.camera.project(wrong_N) - after).norm());
  }
}

}  // namespace

LeftOut left_out(const StudyConfig& config) {
  scenario::Scenario scenario = config.scenario;
  LeftOut result;
  scenario::Camera& camera = scenario.camera;
  result.readout_s = camera.rolling_shutter_s > 0 ? camera.rolling_shutter_s : kReadout_s;
  result.offset_s =
      camera.told.time_offset_error_s != 0 ? camera.told.time_offset_error_s : kOffset_s;
  camera.rolling_shutter_s = camera.exposure_s = camera.told.time_offset_error_s = 0;
  scenario.frames = std::min(scenario.frames, config.effort.drive_frames);
  const sim::Optics optics(config.lens);
  const PointSet points = study_points(config.camera);
  std::vector<double> distortion, readout, readout_field, offset, offset_field;
  const std::vector<sim::Observation> frames = sim::drive(scenario).frames;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Motion now = motion_of(frames[k]);
    add_ways(points, now, result.readout_s, readout, readout_field);
    if (!optics.is_pinhole()) {
      add_distorted(points, optics, T_CN_after(now, config.frame_s()), distortion);
    }
    if (k == 0) continue;
    const Motion before = motion_of(frames[k - 1]);
    add_ways(points, {now.v_mps - before.v_mps, now.w_radps - before.w_radps}, result.offset_s,
             offset, offset_field);
  }
  result.distortion_px = summary(distortion).p95_px;
  result.readout_px = summary(readout).p95_px;
  result.offset_px = summary(offset).p95_px;
  result.expected_readout_px = summary(readout_field).p95_px;
  result.expected_offset_px = summary(offset_field).p95_px;
  return result;
}

}  // namespace lcs::kinematics
