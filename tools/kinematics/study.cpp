#include "tools/kinematics/study.h"

#include <array>
#include <utility>

namespace lcs::kinematics {

constexpr std::array kStudyDepths_m = {1.0, 2.0, 4.0, 8.0, 16.0};
constexpr std::array kLenses_deg = {20.0, 30.0, 45.0, 60.0, 75.0, 90.0, 110.0};
constexpr int kSweeps = 3;

PointSet study_points(const sim::Pinhole& camera) {
  return geometric_points(camera, kStudyDepths_m);
}

int study_pieces(const StudyConfig& config) {
  int frames = 0;
  for (const NamedDrive& drive : drives(config)) frames += drive.scenario.frames;
  return frames + kSweeps + static_cast<int>(kLenses_deg.size()) + sensor_pieces(config);
}

Study carry_out(const StudyConfig& config, const Tick& tick) {
  Study study;
  study.config = config;

  std::vector<PointSet> rendered;
  for (const NamedDrive& drive : drives(config)) {
    DriveResult result = rendered_drive(config, drive, study.drives, tick);
    if (!rendered.empty()) continue;  // the first drive is the configured one
    study.turn_max_rad = result.turn_max_rad;
    rendered = std::move(result.still_frames);
  }

  const std::vector<PointSet> geometric = {study_points(config.camera)};
  for (const auto* points : {&geometric, &std::as_const(rendered)}) {
    sweep_rotation(config, *points, study.rotation);
    sweep_foe_distance(config, *points, study.foe);
    sweep_mount(config, *points, study.mount);
    tick(1);
  }
  sweep_translation(config, rendered, study.translation);
  tick(1);
  for (const double fovy_deg : kLenses_deg) {
    const double fovy_rad = fovy_deg * kDegree;
    const sim::Pinhole camera =
        sim::Pinhole::from_fovy(config.camera.width_px, config.camera.height_px, fovy_rad);
    add_focal_length(config, study_points(camera), fovy_deg, study.focal);
    add_focal_length(config, rendered_with_lens(config, fovy_rad), fovy_deg, study.focal);
    tick(1);
  }
  add_bump_rows(config, study.bumps, tick);
  add_imu_rows(config, study.imu, tick);
  add_drift_rows(config, study.drift, tick);
  study.left_out = left_out(config);
  return study;
}

}  // namespace lcs::kinematics
