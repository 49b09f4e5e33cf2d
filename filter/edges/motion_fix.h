/// \file
/// Estimates the error of the given motion from the misses of likely static tracks. Misses
/// along the parallax count little, as another depth explains them: a depth learnt under a wrong
/// motion would confirm that motion.
#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"

namespace lcs {

/// Share of the tracks that may leave their static predictions; a larger share contradicts the
/// motion.
inline constexpr double kLeave = 0.8;

/// Correction to add to a motion, in the camera frame of k.
struct MotionFix {
  Eigen::Vector3d turn_rad, velocity_mps;
  Eigen::Matrix3d velocity_covariance;  ///< of the corrected velocity, (m/s)^2
};

/// Finds the correction by iterated weighted least squares.
/// \param misses of `TrackLoops::misses`.
/// \param velocity_covariance prior covariance of the error of `told`'s velocity, (m/s)^2.
MotionFix find_motion_fix(const Intrinsics& camera, const MotionField& told,
                          const float* const* misses, std::size_t count,
                          const Eigen::Matrix3d& velocity_covariance);

/// Whether static tracks are at least half of all, and most of them left their predictions: then
/// the motion is wrong.
/// \param misses under the corrected motion.
bool is_contradicted(const float* const* misses, std::size_t count);

/// Estimates the lasting error of the given velocity. Its standard deviation is the estimator's
/// (`EgoMotion::velocity_sigma_mps`), root sum square with a share of the speed.
class VelocityError {
 public:
  /// \param share standard deviation of the camera's velocity, as a share of its speed.
  explicit VelocityError(double share) : share_(share) {}

  /// Predicts the error to the next frame.
  /// \param lasts share of the error that persists.
  void advance(const MotionField& told, double lasts);

  /// The given field, corrected by the estimated error.
  MotionField without(const MotionField& told) const {
    return told.corrected(Eigen::Vector3d::Zero(), mean_mps_);
  }

  /// (m/s)^2: covariance of the error that is left in that field's velocity.
  const Eigen::Matrix3d& covariance() const { return covariance_; }

  /// Adds the correction of that field to the estimate. An error of more than `kFar` standard
  /// deviations is the motion of a body that fills the picture: then the given velocity is right.
  /// \return the correction of that field that is believed.
  Eigen::Vector3d update(const MotionFix& fix);

  void forget() { *this = VelocityError(share_); }

 private:
  double share_;
  // In the camera frame of k.
  Eigen::Vector3d mean_mps_ = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_ = Eigen::Matrix3d::Zero();
  double sigma_mps_ = 0;  // of the whole error in the last frame
};

}  // namespace lcs
