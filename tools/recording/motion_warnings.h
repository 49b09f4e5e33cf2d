/// \file
/// Signs that the told motion is not the camera's, or that the verdicts are useless, found from
/// corners, verdicts and told motion alone.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "tools/recording/recording.h"

namespace lcs::bench {

struct MotionWarning {
  const char* word;        ///< "warnings.WORD" is the metric
  std::int64_t count = 0;  ///< frames in which this was seen
  std::string text;        ///< the first time, and what to do; empty for none
};

/// Faster than any road vehicle: dead reckoning has diverged, or the unit is wrong.
inline constexpr double kRunawaySpeed_mps = 70;

/// A larger share of rebels is not believed: most of what is seen does not move by itself.
inline constexpr double kManyRebels = 0.3;

/// The four warnings, in this order:
///
/// * runaway_speed: told velocities above `kRunawaySpeed_mps`;
/// * turn_not_told: frames in which most corners have moved by the same vector of 3 px or more,
///   while the told motion has neither a rotation nor a part to the side; given from five such
///   frames on;
/// * still_camera: stretches in which the camera is told to have moved by 1 m, but nearly all
///   corners stayed where they were; given from three on, if nine in ten are so;
/// * many_rebels: frames with more than `kManyRebels` among the corners; given if they are more
///   than half.
std::array<MotionWarning, 4> motion_warnings(const Recording& recording);

}  // namespace lcs::bench
