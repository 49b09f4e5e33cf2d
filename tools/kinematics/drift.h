/// \file
/// Dead reckoning without pictures: the drift of attitude and velocity on a straight drive from a
/// known start, with and without odometry, beside the theoretical drift.
#pragma once

#include <vector>

#include "tools/kinematics/imu_study.h"

namespace lcs::kinematics {

/// Root mean square errors of attitude, and of velocity in the rover's frame.
struct DriftErrors {
  double tilt_rad = 0;     ///< about each horizontal axis
  double heading_rad = 0;  ///< about the vertical
  double forward_mps = 0;
  double lateral_mps = 0;
  double vertical_mps = 0;
};

struct DriftRow {
  std::string imu;
  bool odometry = false;
  double t_s = 0;
  int seeds = 0;
  DriftErrors rms;       ///< over the seeds, after `t_s`
  DriftErrors expected;  ///< by `theory.h`; with odometry for a settled filter
};

/// One row for each second.
std::vector<DriftRow> drift_rows(const StudyConfig& config, const Tick& tick);
int drift_pieces(const StudyConfig& config);

}  // namespace lcs::kinematics
