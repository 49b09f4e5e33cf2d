/// \file
/// Validates the given ego-motion: accepts it, accepts it without the ground, or rejects it.
#pragma once

#include <optional>

#include "filter/kinematics/ego_motion.h"
#include "filter/types/diagnostics.h"

namespace lcs {

/// s: a longer step between two frames resets the filter.
inline constexpr double kLongestStep_s = 60;

/// m/s: a faster motion is invalid input.
inline constexpr double kMostSpeed_mps = 1000;

class Intake {
 public:
  /// \return the motion; absent if unusable. Counts the fault in `diagnostics`.
  std::optional<EgoMotion> take(const EgoMotion& told, Diagnostics& diagnostics);

 private:
  bool is_first_ = true;  ///< no frame came before
};

/// Whether a matrix is a rotation, up to rounding to a few decimals.
bool is_rotation(const Eigen::Matrix3d& R);

}  // namespace lcs
