/// \file
/// Estimates the error of the told motion from tracks that are likely to be static, by how far each
/// corner is from where it was expected, across the parallax: along it another depth explains all,
/// and a depth that was learnt under a wrong motion would confirm that motion.
#pragma once

#include <Eigen/Core>
#include <span>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"

namespace lcs {

/// How far a corner is from where its track was expected if it stands.
struct Residual {
  Vec2 place_px, off_px;
  Eigen::Matrix2d covariance_px2;  ///< of the latter, by the depth that the track has
  Vec2 by_depth_px;                ///< what half of the depths that it may have move it by
  double inverse_depth_pm = 0, inverse_depth_variance_pm2 = 0;
  double voice = 1;           ///< what it counts for: those of one body are off together
  double stands = 1;          ///< chance that the point is static
  double otherwise_ppx2 = 0;  ///< density of the corner there if not, times the chance of it
};

/// To be added to a motion, in the camera frame of k.
struct MotionFix {
  Eigen::Vector3d turn_rad, velocity_mps;
  Eigen::Matrix3d velocity_covariance;  ///< of what is left of the latter, (m/s)^2
};

/// \param velocity_covariance of what is wrong with the told velocity before anything is seen.
MotionFix motion_fix(const Intrinsics& camera, const MotionField& told,
                     std::span<const Residual> residuals,
                     const Eigen::Matrix3d& velocity_covariance);

/// Whether most of what stood, and that half of all, has left the places that this motion gives it,
/// so that it is the motion that is wrong.
/// \param residuals under the motion as fixed.
bool is_contradicted(std::span<const Residual> residuals);

/// The error of the told velocity. All the while it is as large as the estimator says
/// (`EgoMotion::velocity_sigma_mps`) and a share of the speed; most of it lasts.
class VelocityError {
 public:
  /// \param share of its speed by which the camera's velocity may be wrong.
  explicit VelocityError(double share) : share_(share) {}

  /// To the next frame.
  /// \param lasts share of the error that is still the same.
  void advance(const MotionField& told, double lasts);

  /// The told field, corrected by the error as far as that is known.
  MotionField without(const MotionField& told) const {
    return told.corrected(Eigen::Vector3d::Zero(), mean_mps_);
  }

  /// (m/s)^2: of the error that is left in that field's velocity.
  const Eigen::Matrix3d& covariance() const { return covariance_; }

  /// Updates the estimate by the error of that field.
  void see(const MotionFix& fix) {
    mean_mps_ += fix.velocity_mps;
    covariance_ = fix.velocity_covariance;
  }

  void forget() { *this = VelocityError(share_); }

 private:
  double share_;
  // In the camera frame of k.
  Eigen::Vector3d mean_mps_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  double sigma_mps_ = 0;  // of the whole error, in the last frame
};

}  // namespace lcs
