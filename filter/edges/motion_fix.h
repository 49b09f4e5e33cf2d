/// \file
/// Estimates the error of the told motion from tracks that are likely to be static, by how far each
/// corner is from where it was expected. While the camera travels, only the part across the
/// parallax is used: any distance along it can be explained by another depth, and a depth that was
/// learnt under a wrong motion would confirm that motion.
#pragma once

#include <Eigen/Core>
#include <span>

#include "filter/edges/gauss.h"
#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"

namespace lcs {

/// How far a corner is from where its track was expected if it stands.
struct Residual {
  Vec2 place_px, off_px;
  Eigen::Matrix2d covariance_px2;  ///< of the latter, whatever its depth
  double inverse_depth_pm = 0, inverse_depth_variance_pm2 = 0;
  double voice = 1;   ///< what it counts for: those of one body are off together
  double stands = 1;  ///< chance that the point is static
  double otherwise_ppx2 =
      0;                   ///< density of the corner there if it does not, times the chance of it
  double moving_ppx2 = 0;  ///< the same, were it not known to stand
};

/// To be added to a motion, in the camera frame of k.
struct MotionFix {
  Eigen::Vector3d turn_rad, velocity_mps;
  Eigen::Matrix3d velocity_covariance;  ///< of what is left of the latter, (m/s)^2
  double log_evidence = 0;              ///< ln p of all places, be what each corner is not known
};

/// \param velocity_covariance of what is wrong with the told velocity before anything is seen, and
///   \param velocity_mps its mean.
MotionFix motion_fix(const Intrinsics& camera, const MotionField& field,
                     std::span<const Residual> residuals,
                     const Eigen::Matrix3d& velocity_covariance,
                     const Eigen::Vector3d& velocity_mps = Eigen::Vector3d::Zero());

/// The error of the told velocity: one that lasts, as large as the estimator says
/// (`EgoMotion::velocity_sigma_mps`) or as the wheels may slip, and one of each frame by itself.
class VelocityError {
 public:
  /// \param ego_share of its speed by which the camera's velocity may be wrong in a frame.
  /// \param slip_share of its speed by which it may be wrong for long.
  explicit VelocityError(double ego_share, double slip_share = 0)
      : ego_share_(ego_share), slip_share_(slip_share) {}

  /// To the next frame.
  void advance(const MotionField& told);

  /// The told field, corrected by the lasting error as far as that is known.
  MotionField without(const MotionField& told) const;

  /// (m/s)^2: covariance of the error that is left in that field's velocity.
  Eigen::Matrix3d covariance(const MotionField& field) const;

  /// Updates the estimate by the error of that field.
  void see(const MotionFix& fix, const MotionField& field);

  const Eigen::Vector3d& lasting_mps() const { return lasting_mps_; }

 private:
  double ego_share_, slip_share_;
  // Of the error that lasts, in the camera frame of k.
  Eigen::Vector3d lasting_mps_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d lasting_covariance_ = Eigen::Matrix3d::Zero();
  double sigma_mps_ = 0;  // of it, in the last frame, before anything was seen
};

/// The error of the told velocity under two hypotheses, that the wheels grip and that they slip:
/// then the velocity may be anything of the size that is told.
class MotionError {
 public:
  MotionError(double ego_share, double prior)
      : log_odds_(log_odds(prior)), grip_(ego_share), slip_(ego_share, 1) {}

  /// To the next frame.
  void advance(const MotionField& told);

  /// The told field, without the lasting error under the likelier hypothesis.
  MotionField without(const MotionField& told) const { return likelier().without(told); }

  /// What is left to be found in the field of `without`, by what is likelier given this frame.
  MotionFix fix(const Intrinsics& camera, const MotionField& field,
                std::span<const Residual> residuals, const Fading& fading);

  bool slips() const { return log_odds_ > 0; }

 private:
  const VelocityError& likelier() const { return slips() ? slip_ : grip_; }

  double log_odds_;  // that they slip
  VelocityError grip_, slip_;
};

}  // namespace lcs
