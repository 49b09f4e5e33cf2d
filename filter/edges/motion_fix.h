/// \file
/// Estimates the error of the given motion from the residuals of likely static tracks. Residuals
/// along the parallax count little, as another depth explains them: a depth learnt under a wrong
/// motion would confirm that motion.
#pragma once

#include <Eigen/Core>
#include <span>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"

namespace lcs {

/// Share of the tracks that may leave their static predictions; a larger share contradicts the
/// motion.
inline constexpr double kLeave = 0.8;

/// Distance of a corner from the static prediction of its track.
struct Residual {
  Vec2 place_px, off_px;
  Eigen::Matrix2d covariance_px2;  ///< of `off_px`, at the track's depth
  Vec2 by_depth_px;                ///< image shift by half of the range of depths
  double inverse_depth_pm = 0, inverse_depth_variance_pm2 = 0;
  double voice = 1;           ///< weight: tracks of one body are off together
  double stands = 1;          ///< chance that the point is static
  double otherwise_ppx2 = 0;  ///< density of the corner if not static, times 1 - `stands`
};

/// Correction to add to a motion, in the camera frame of k.
struct MotionFix {
  Eigen::Vector3d turn_rad, velocity_mps;
  Eigen::Matrix3d velocity_covariance;  ///< of the corrected velocity, (m/s)^2
};

/// Finds the correction by iterated weighted least squares. Keeps its memory.
class MotionFinder {
 public:
  /// \param velocity_covariance prior covariance of the error of `told`'s velocity, (m/s)^2.
  MotionFix find(const Intrinsics& camera, const MotionField& told,
                 std::span<const Residual> residuals, const Eigen::Matrix3d& velocity_covariance);

 private:
  void place(const Intrinsics& camera, const MotionField& told, std::span<const Residual> residuals,
             double velocity_variance_m2ps2);

  /// Columns for `Loops`.
  std::vector<double> h_x_, h_y_, motion_s_, off_x_px_, off_y_px_, S_xx_px2_, S_xy_px2_, S_yy_px2_,
      voice_, stands_, otherwise_ppx2_;
};

/// Whether static tracks are at least half of all, and most of them left their predictions: then
/// the motion is wrong.
/// \param residuals under the corrected motion.
bool is_contradicted(std::span<const Residual> residuals);

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
