/// \file
/// The subject of a study: a camera, a rover and an IMU, taken from a scenario; and the size of
/// each experiment.
#pragma once

#include <Eigen/Core>

#include "filter/kinematics/geometry.h"
#include "filter/paper/any_filter.h"
#include "scenarios/scenario.h"
#include "sim/drive.h"

namespace lcs::kinematics {

/// Size of the experiments that take long. All others do not depend on it.
struct Effort {
  int drive_frames = 40;  ///< of each rendered drive
  int noise_seeds = 20;   ///< of each IMU at each frame rate
  int drift_seeds = 300;  ///< of each IMU
  double drift_s = 60;
  static Effort full() { return {}; }
  static Effort quick() { return {.drive_frames = 15, .noise_seeds = 5, .drift_seeds = 25}; }
};

struct StudyConfig {
  scenario::Scenario
      scenario;  ///< without the lens: its camera is the pinhole that the filter gets
  sim::Lens lens;
  AnyParameters filter;
  Effort effort;
  /// Nominal speed: the fastest commanded at the start of a phase of the scenario.
  double speed_mps = 0;
  double tolerance_px = 1;  ///< bound of an end-point error in the verdicts
  bool stands = false;      ///< the scenario's rover never moves, so the speed is a substitute
  Eigen::Vector3d forward_C = Eigen::Vector3d::UnitZ();  ///< the rover's x in the camera
  sim::Pinhole camera;

  double frame_s() const { return 1 / scenario.camera.rate_hz; }
  /// Distance that the camera travels in a frame, straight ahead.
  Eigen::Vector3d step_C_m() const { return speed_mps * frame_s() * forward_C; }
};

/// \throws input::Error for an invalid filter setting.
StudyConfig configure(const scenario::Scenario& scenario, const Effort& effort);

/// \name Scenarios made from the configured one.
///@{
/// The holonomic rover drives straight ahead at nominal speed, with ideal sensors and no actors.
scenario::Scenario straight_drive(const StudyConfig& config, double duration_s, double rate_hz);
/// The same on a curve of `yaw_rate_radps`.
scenario::Scenario curved_drive(const StudyConfig& config, double duration_s, double rate_hz,
                                double yaw_rate_radps);
/// The same on wheels, over bumps of this roughness; 0 is level ground.
scenario::Scenario bumpy_drive(const StudyConfig& config, double duration_s, double rate_hz,
                               double roughness_m);
///@}

/// The readings of a drive with ideal sensors, with noise added.
sim::Drive with_noise(const sim::Drive& ideal, const scenario::Scenario& noisy);

}  // namespace lcs::kinematics
