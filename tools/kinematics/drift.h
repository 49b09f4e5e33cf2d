/// \file
/// The IMU's path apart from any picture: by how much attitude and velocity drift on a straight
/// drive from a known start, with and without odometry, beside what theory expects.
#pragma once

#include <vector>

#include "tools/kinematics/imu_study.h"

namespace lcs::kinematics {

/// Root mean squares, over seeds, after `t_s`, and what `theory.h` expects. With odometry the
/// expected velocities are those of a filter that has settled, which takes some seconds.
struct DriftRow {
  std::string imu;
  bool odometry = false;
  double t_s = 0;
  int seeds = 0;
  double tilt_rad = 0;     ///< about each horizontal axis
  double heading_rad = 0;  ///< about the vertical
  /// \name Velocity in the rover's frame, m/s.
  ///@{
  double forward_mps = 0;
  double lateral_mps = 0;
  double vertical_mps = 0;
  ///@}
  double expected_tilt_rad = 0;
  double expected_heading_rad = 0;
  double expected_forward_mps = 0;
  double expected_lateral_mps = 0;
  double expected_vertical_mps = 0;
};

/// A row for each second.
std::vector<DriftRow> drift_rows(const StudyConfig& config, const Tick& tick);
int drift_pieces(const StudyConfig& config);

}  // namespace lcs::kinematics
