/// \file
/// Checks the ego-motion that the filter is told, and accepts all of it, all but the ground, or
/// nothing.
#pragma once

#include <optional>

#include "filter/diagnostics.h"
#include "filter/kinematics/ego_motion.h"

namespace lcs {

/// A longer step between two frames starts the filter anew: what it knew is of no use.
inline constexpr double kLongestStep_s = 60;

/// A faster motion is a broken input, not that of a vehicle.
inline constexpr double kMostSpeed_mps = 1000;

class Intake {
 public:
  /// \return the motion; none where it cannot be used, which the diagnostics count.
  std::optional<EgoMotion> take(const EgoMotion& told, Diagnostics& diagnostics);

 private:
  bool is_first_ = true;  ///< nothing came before that time could have passed since
};

/// Whether a matrix is a rotation, but for what a few decimals leave.
bool is_rotation(const Eigen::Matrix3d& R);

}  // namespace lcs
