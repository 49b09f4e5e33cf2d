/// \file
/// Signs that the told motion is not the camera's, or that the verdicts are of no use, found in
/// corners, verdicts and told motion alone.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "tools/recording/recording.h"

namespace lcs::bench {

struct MotionWarning {
  const char* word;        ///< "warnings.WORD" is the metric
  std::int64_t count = 0;  ///< frames in which it was so
  std::string text;        ///< the first time, and what to do; empty for none
};

/// Faster than what drives on a road: dead reckoning that has run away, or a unit that is none.
inline constexpr double kRunawaySpeed_mps = 70;

/// Most of what is seen does not move by itself.
inline constexpr double kManyRebels = 0.3;

/// The four warnings, in this order:
///
/// * runaway_speed: told velocities above `kRunawaySpeed_mps`;
/// * turn_not_told: frames in which most corners have moved by one and the same vector, 3 px long
///   at least, and nobody told of a turn, nor of a motion to the side; if they are five or more;
/// * still_camera: times that the camera should have gone on by 1 m, and nearly all corners are
///   where they were; if it is so nine times in ten, and three times at least;
/// * many_rebels: frames with so many rebels among the corners; if they are more than half.
std::array<MotionWarning, 4> motion_warnings(const Recording& recording);

}  // namespace lcs::bench
