/// \file
/// Experiments on rendered pictures: the filter tracks corners and learns their V on drives, and
/// each model's predictions of its landmarks are compared with the simulator's truth.
#pragma once

#include <functional>
#include <vector>

#include "tools/kinematics/points.h"
#include "tools/kinematics/study_config.h"

namespace lcs::kinematics {

using Tick = std::function<void(int)>;  ///< called with the number of pieces of work just done

struct DriveRow {
  std::string drive;  ///< "configured", "straight", "turning", "bumps"
  std::string told;   ///< source of the motion: "truth", or "imu" as configured
  Model model;
  ErrorSummary error;
  /// For the reference depth with true motion: V_v t_f |Z_ref / Z - 1|; NaN for others.
  double expected_median_px = 0;
  double turn_max_rad = 0;  ///< the camera's largest true turn from a frame to the next
};

struct DriveResult {
  std::vector<DriveRow> rows;
  std::vector<PointSet> still_frames;  ///< some of the frames, for the geometric experiments
};

/// Landmarks are the filter's normal edges on fixed objects with a corner in the frame. The
/// filter's motion comes from the scenario's own sensors.
DriveResult rendered_drive(const StudyConfig& config, const std::string& name,
                           const scenario::Scenario& scenario, const Tick& tick);

/// The four drives: as configured, straight ahead, turning by `kTurning_deg` a frame, over bumps.
/// Sensors are as configured.
inline constexpr double kTurning_deg = 1;
struct NamedDrive {
  std::string name;
  scenario::Scenario scenario;
};
std::vector<NamedDrive> drives(const StudyConfig& config);

/// The first frame of the configured scenario with another lens.
PointSet rendered_with_lens(const StudyConfig& config, double fovy_rad);

}  // namespace lcs::kinematics
