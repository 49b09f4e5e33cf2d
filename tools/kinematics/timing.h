/// \file
/// The error of a prediction that leaves out the distortion, the rolling shutter or the time offset
/// of the camera, at the motions of the configured drive.
#pragma once

#include <vector>

#include "tools/kinematics/study_config.h"

namespace lcs::kinematics {

/// The 95th percentile of the errors over frames and geometric points, px.
struct LeftOut {
  double distortion_px = 0;  ///< of the motion from frame to frame; 0 for a pinhole
  double readout_s = 0;      ///< the scenario's, or else `kReadout_s`
  double readout_px = 0;     ///< of the last row, which is seen that much later than the first
  double offset_s = 0;       ///< of the clocks, as told to the filter, or else `kOffset_s`
  double offset_px = 0;      ///< of the motion from frame to frame: it is that of another interval
  /// \name By the first-order motion field, in place of the exact motion.
  ///@{
  double expected_readout_px = 0;
  double expected_offset_px = 0;
  ///@}
};

inline constexpr double kReadout_s = 0.02;
inline constexpr double kOffset_s = 0.005;

/// \throws input::Error, sim::PhysicsError
LeftOut left_out(const StudyConfig& config);

}  // namespace lcs::kinematics
