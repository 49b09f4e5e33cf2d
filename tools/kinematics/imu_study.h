/// \file
/// Errors by the sensors: end-point errors of the exact model (homography, true depth) where a
/// noisy IMU tells the motion, and of all rotation models where wheels roll over bumps. Poses and
/// readings are MuJoCo's; points are geometric.
#pragma once

#include <vector>

#include "tools/kinematics/rendered.h"

namespace lcs::kinematics {

/// An IMU to be tried, by its name.
struct NamedImu {
  std::string name;
  scenario::ImuNoise noise;
};
/// The scenario's own first, then the other presets.
std::vector<NamedImu> imus(const StudyConfig& config);

/// The configured scenario with another IMU; odometry is the scenario's own, or the default one.
scenario::Scenario with_imu(const StudyConfig& config, const scenario::ImuNoise& noise,
                            bool odometry);

inline constexpr double kImuDrive_s = 10;  ///< from a known start

struct ImuRow {
  std::string imu;
  double rate_hz = 0;  ///< of the camera
  bool odometry = false;
  int seeds = 0;
  ErrorSummary error;           ///< of all frames and seeds
  ErrorSummary rotation_error;  ///< likewise, with the true velocity
  double expected_rms_px = 0;   ///< by `theory.h`
  double expected_rotation_rms_px = 0;
};
std::vector<ImuRow> imu_rows(const StudyConfig& config, const Tick& tick);
int imu_pieces(const StudyConfig& config);  ///< of work, for `tick`

struct BumpRow {
  double roughness_m = 0;
  double turn_median_deg = 0, turn_p95_deg = 0, turn_max_deg = 0;  ///< of the camera in a frame
  std::string rotation;  ///< the model's name, or "none": no rotation is taken out
  std::string told;      ///< "truth" or "imu"
  ErrorSummary error;    ///< with the true depth
  /// For "none" the first order of the turns, for first order the second; NaN for others.
  double expected_rms_px = 0;
};
std::vector<BumpRow> bump_rows(const StudyConfig& config, const Tick& tick);
int bump_pieces();

}  // namespace lcs::kinematics
