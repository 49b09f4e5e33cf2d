/// \file
/// Errors caused by the sensors: end-point errors of the exact model (homography, true depth) with
/// motion from a noisy IMU, and of all rotation models with wheels on bumps. Poses and readings
/// come from MuJoCo; points are geometric.
#pragma once

#include <vector>

#include "tools/kinematics/rendered.h"

namespace lcs::kinematics {

/// An IMU under test, by its name.
struct NamedImu {
  std::string name;
  scenario::ImuNoise noise;
};
/// The scenario's own IMU first, then the other presets.
std::vector<NamedImu> imus(const StudyConfig& config);

/// The configured scenario with another IMU. Odometry is the scenario's own, or else the default.
scenario::Scenario with_imu(const StudyConfig& config, const scenario::ImuNoise& noise,
                            bool odometry);

inline constexpr double kImuDrive_s = 10;  ///< from a known start

struct ImuRow {
  std::string imu;
  double rate_hz = 0;  ///< of the camera
  bool odometry = false;
  int seeds = 0;
  ErrorSummary error;           ///< over all frames and seeds
  ErrorSummary rotation_error;  ///< as `error`, with the true velocity
  double expected_rms_px = 0;   ///< by `theory.h`
  double expected_rotation_rms_px = 0;
};
std::vector<ImuRow> imu_rows(const StudyConfig& config, const Tick& tick);
int imu_pieces(const StudyConfig& config);  ///< of work, for `tick`

struct BumpRow {
  double roughness_m = 0;
  double turn_median_deg = 0, turn_p95_deg = 0, turn_max_deg = 0;  ///< of the camera in a frame
  std::string rotation;  ///< the model's name, or "none": no rotation is compensated
  std::string told;      ///< "truth" or "imu"
  ErrorSummary error;    ///< with the true depth
  /// For "none" the first order of the turns, for first order the second; NaN for others.
  double expected_rms_px = 0;
};
std::vector<BumpRow> bump_rows(const StudyConfig& config, const Tick& tick);
int bump_pieces();

}  // namespace lcs::kinematics
