#include "tools/kinematics/study_config.h"

#include <algorithm>
#include <cmath>

#include "sim/imu/imu_noise.h"
#include "tools/bench/detector.h"

namespace lcs::kinematics {

constexpr double kStandInSpeed_mps = 0.5;  // if the scenario's rover is static

StudyConfig configure(const scenario::Scenario& scenario, const Effort& effort) {
  StudyConfig config;
  config.scenario = scenario;
  config.lens = sim::lens_of(scenario.camera);
  // the filter gets corners without distortion
  scenario::Camera& camera = config.scenario.camera;
  if (camera.focal_px || camera.distortion) {
    camera.fovy_rad = 2 * std::atan(camera.height_px / 2.0 / config.lens.pinhole().focal_px);
    camera.focal_px.reset();
    camera.distortion.reset();
  }
  config.filter = bench::filter_parameters(scenario);
  config.effort = effort;
  for (const scenario::EgoPhase& phase : scenario.ego.phases) {
    config.speed_mps = std::max(config.speed_mps, phase.speed_mps);
  }
  const std::vector<scenario::Waypoint>& points = scenario.ego.waypoints;
  for (std::size_t i = 1; i < points.size(); ++i) {
    config.speed_mps =
        std::max(config.speed_mps, (points[i].position_m - points[i - 1].position_m).norm() /
                                       (points[i].at_s - points[i - 1].at_s));
  }
  config.stands = config.speed_mps <= field_of(config.filter).still_speed_mps;
  if (config.stands) config.speed_mps = kStandInSpeed_mps;
  const sim::Calibration calibration = sim::drive(straight_drive(config, 0, 1)).calibration;
  config.camera = calibration.camera;
  config.forward_C = calibration.T_BC.R.transpose() * Eigen::Vector3d::UnitX();
  return config;
}

scenario::Scenario straight_drive(const StudyConfig& config, double duration_s, double rate_hz) {
  scenario::Scenario s = config.scenario;
  s.frames = static_cast<int>(std::floor(duration_s * rate_hz + 1e-9)) + 1;
  s.ego.drive = scenario::Drive::holonomic;
  s.ego.phases = {{.speed_mps = config.speed_mps}};
  s.ego.waypoints.clear();
  s.ego.path.clear();
  s.camera.rate_hz = rate_hz;
  s.camera.rolling_shutter_s = s.camera.exposure_s = s.camera.told.time_offset_error_s = 0;
  s.imu.noise = {};
  s.imu.gyroscopes = {};
  s.imu.accelerometers = {};
  s.imu.gaps.clear();
  s.odometry.enabled = true;
  s.odometry.noise_mps = s.odometry.yaw_noise_radps = s.odometry.scale_error = 0;
  s.ego_motion = scenario::EgoMotionSource::imu;
  s.image = {};
  s.image.noise.reset();
  s.ground.reset();
  s.actors.clear();
  return s;
}

scenario::Scenario curved_drive(const StudyConfig& config, double duration_s, double rate_hz,
                                double yaw_rate_radps) {
  scenario::Scenario s = straight_drive(config, duration_s, rate_hz);
  s.ego.phases[0].yaw_rate_radps = yaw_rate_radps;
  return s;
}

scenario::Scenario bumpy_drive(const StudyConfig& config, double duration_s, double rate_hz,
                               double roughness_m) {
  scenario::Scenario s = straight_drive(config, duration_s, rate_hz);
  s.ego.drive = scenario::Drive::wheeled;
  s.ground = config.scenario.ground.value_or(scenario::RoughGround{});
  s.ground->roughness_m = roughness_m;
  if (roughness_m == 0) s.ground.reset();
  return s;
}

sim::Drive with_noise(const sim::Drive& ideal, const scenario::Scenario& noisy) {
  sim::Drive drive = ideal;
  sim::ImuNoiseModel imu(noisy.imu, noisy.seed);
  sim::OdometryNoiseModel odometry(noisy.odometry, noisy.seed);
  for (sim::Observation& frame : drive.frames) {
    for (sim::ImuSample& sample : frame.imu) sample = imu.corrupt(sample);
    if (!noisy.odometry.enabled) frame.odometry.clear();
    for (sim::OdometrySample& sample : frame.odometry) sample = odometry.corrupt(sample);
  }
  return drive;
}

}  // namespace lcs::kinematics
