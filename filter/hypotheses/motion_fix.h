/// \file
/// What the told motion is off by, from tracks that are likely to stand: each says how far its
/// corner is from where it was expected. Where the camera travels a depth explains any distance
/// along the parallax, so that only what is across it speaks: a depth that was learnt under a wrong
/// motion would bear that motion out.
#pragma once

#include <Eigen/Core>
#include <span>

#include "filter/camera.h"
#include "filter/motion_field.h"

namespace lcs {

/// How far a corner is from where its track was expected if it stands.
struct Residual {
  Vec2 place_px, off_px;
  Eigen::Matrix2d covariance_px2;  ///< of the latter, whatever its depth
  double inverse_depth_pm = 0, inverse_depth_variance_pm2 = 0;
  double stands = 1;  ///< chance of it
  double otherwise_ppx2 =
      0;  ///< density of the corner there if it does not, times the chance of it
};

/// To be added to a motion, in the camera frame of k.
struct MotionFix {
  Eigen::Vector3d turn_rad = Eigen::Vector3d::Zero();
  Eigen::Vector3d velocity_mps = Eigen::Vector3d::Zero();
};

/// \param ego_share of its speed by which the camera's velocity may be wrong on an axis.
/// \return zero where too few tell.
MotionFix motion_fix(const Intrinsics& camera, const MotionField& told,
                     std::span<const Residual> residuals, double ego_share);

}  // namespace lcs
