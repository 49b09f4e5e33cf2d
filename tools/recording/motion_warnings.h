/// \file
/// Signs that the estimated motion is not the camera's, or that the verdicts are useless. They use
/// only corners, verdicts and the estimated motion.
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "tools/recording/recording.h"

namespace lcs::bench {

struct MotionWarning {
  const char* word;        ///< "warnings.WORD" is the metric
  std::int64_t count = 0;  ///< frames in which it occurred
  std::string text;        ///< first occurrence and remedy; empty if it did not occur
};

/// Faster than any road vehicle: dead reckoning has diverged, or the unit is wrong.
inline constexpr double kRunawaySpeed_mps = 70;

/// A larger share of rebels is implausible: most of the scene does not move by itself.
inline constexpr double kManyRebels = 0.3;

/// The four warnings, in this order:
///
/// * runaway_speed: estimated speeds above `kRunawaySpeed_mps`;
/// * turn_not_told: most corners have moved by the same vector of 3 px or more, but the estimated
///   motion has neither rotation nor sideways velocity; reported from five such frames on;
/// * still_camera: the estimated motion adds up to 1 m, but nearly all corners stayed in place;
///   reported from three such stretches on, if they are nine in ten;
/// * many_rebels: at least the share `kManyRebels` of the corners are rebels; reported if this
///   holds in more than half of the frames.
std::array<MotionWarning, 4> motion_warnings(const Recording& recording);

}  // namespace lcs::bench
