/// \file
/// The experiments on rendered pictures: drives in which the filter itself tracks corners and
/// learns their V, and every model's prediction of its landmarks is held against the simulator's
/// truth.
#pragma once

#include <functional>
#include <vector>

#include "tools/kinematics/field_picture.h"
#include "tools/kinematics/points.h"
#include "tools/kinematics/study_config.h"

namespace lcs::kinematics {

using Tick = std::function<void(int)>;  ///< told of each piece of work that is done

struct DriveRow {
  std::string drive;  ///< "configured", "straight", "turning", "bumps"
  std::string told;   ///< by whom the motion is: "truth", or "imu" as configured
  Model model;
  ErrorSummary error;
  /// For the reference depth and the true motion V_v t_f |Z_ref / Z - 1|; NaN for others.
  double expected_median_px = 0;
};

/// An error at a place of the image.
struct ErrorAt {
  Vec2 px = Vec2::Zero();
  double error_px = 0;
};

struct DriveResult {
  std::vector<DriveRow> rows;
  std::vector<ErrorAt> learnt;         ///< of the homography and the learnt V, told by the IMU
  std::vector<PointSet> still_frames;  ///< some of the frames, for the geometric experiments
  FieldFrame field;                    ///< the frame with most corners on movers
};

/// The landmarks are the filter's normal edges that found a corner in the frame and that lie on
/// what is fixed; the filter is told the motion by the scenario's own sensors.
DriveResult rendered_drive(const StudyConfig& config, const std::string& name,
                           const scenario::Scenario& scenario, const Tick& tick);

/// The four drives: as configured, straight on, turning by `kTurning_deg` a frame, over bumps.
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
