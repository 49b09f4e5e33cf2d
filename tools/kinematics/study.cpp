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
  return frames + kSweeps + static_cast<int>(kLenses_deg.size()) + bump_pieces() +
         imu_pieces(config) + drift_pieces(config);
}

Study carry_out(const StudyConfig& config, const Tick& tick) {
  Study study;
  study.config = config;

  std::vector<PointSet> rendered;
  for (const NamedDrive& drive : drives(config)) {
    DriveResult result = rendered_drive(config, drive.name, drive.scenario, tick);
    append(study.drives, std::move(result.rows));
    if (rendered.empty()) rendered = std::move(result.still_frames);
  }

  const std::vector<PointSet> geometric = {study_points(config.camera)};
  for (const auto* points : {&geometric, &std::as_const(rendered)}) {
    append(study.rotation, sweep_rotation(config, *points));
    append(study.foe, sweep_foe_distance(config, *points));
    append(study.mount, sweep_mount(config, *points));
    tick(1);
  }
  study.translation = sweep_translation(config, rendered);
  tick(1);
  for (const double fovy_deg : kLenses_deg) {
    const double fovy_rad = fovy_deg * kDegree;
    const sim::Pinhole camera =
        sim::Pinhole::from_fovy(config.camera.width_px, config.camera.height_px, fovy_rad);
    study.focal.push_back(focal_row(config, study_points(camera), fovy_deg));
    study.focal.push_back(focal_row(config, rendered_with_lens(config, fovy_rad), fovy_deg));
    tick(1);
  }
  study.bumps = bump_rows(config, tick);
  study.imu = imu_rows(config, tick);
  study.drift = drift_rows(config, tick);
  study.left_out = left_out(config);
  return study;
}

}  // namespace lcs::kinematics
