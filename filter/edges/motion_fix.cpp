#include "filter/edges/motion_fix.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "filter/edges/gauss.h"
#include "filter/edges/tracks.h"
#include "filter/matching/point_grid.h"

namespace lcs {
namespace {

/// Prior standard deviation of the error of a frame's given rotation, on each axis.
constexpr double kTurn_rad = 1e-3;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Lower triangle of a Cholesky factor, row by row; zeros where the matrix is singular.
std::array<float, 21> root_of(const Matrix6& covariance) {
  std::array<double, 21> root{};
  const auto at = [&](int row, int column) -> double& {
    return root[row * (row + 1) / 2 + column];
  };
  for (int column = 0; column < 6; ++column) {
    double rest = covariance(column, column);
    for (int k = 0; k < column; ++k) rest -= at(column, k) * at(column, k);
    if (!(rest > 1e-14 * covariance(column, column))) continue;
    at(column, column) = std::sqrt(rest);
    for (int row = column + 1; row < 6; ++row) {
      double entry = covariance(row, column);
      for (int k = 0; k < column; ++k) entry -= at(row, k) * at(column, k);
      at(row, column) = entry / at(column, column);
    }
  }
  std::array<float, 21> rounded{};
  std::ranges::copy(root, rounded.begin());
  return rounded;
}

}  // namespace

MotionFix find_motion_fix(const Intrinsics& camera, const MotionField& told,
                          const float* const* misses, std::size_t count,
                          const Eigen::Matrix3d& velocity_covariance) {
  const double turn = std::hypot(kTurn_rad, told.unseen_turn_rad());
  Matrix6 prior = Matrix6::Zero();  // not inverted: 0 if the motion is exact
  prior.topLeftCorner<3, 3>().diagonal().setConstant(turn * turn);
  prior.bottomRightCorner<3, 3>() = velocity_covariance;
  Matrix6 left_open = prior, covariance = prior;
  Vector6 fix = Vector6::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    NormalSums sums;
    const Eigen::Matrix<float, 6, 1> present = fix.cast<float>();
    track_loops().normal_sums(misses, count, static_cast<float>(camera.focal_px), present.data(),
                              root_of(left_open).data(), sums);
    Matrix6 information;
    for (int row = 0, entry = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column, ++entry) {
        information(row, column) = information(column, row) = sums.information[entry];
      }
    }
    covariance = (Matrix6::Identity() + prior * information).inverse() * prior;
    const Vector6 before = fix;
    fix = covariance * Eigen::Map<const Vector6>(sums.pull);
    // Wrong matches pull the first rounds far off; later rounds search closer. None is needed once
    // the fix moved less than the search narrows, in standard deviations.
    const double open = std::pow(kFar, -2 * (iteration + 1));
    if (iteration > 1 && (fix - before).dot(information * (fix - before)) < open) break;
    left_open = covariance + prior * open;
  }
  // Places of a billion focal lengths overflow: then nothing is known about the motion.
  if (!fix.allFinite() || !covariance.allFinite()) {
    return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), velocity_covariance};
  }
  return {fix.head<3>(), fix.tail<3>(), covariance.bottomRightCorner<3, 3>()};
}

bool is_contradicted(const float* const* misses, std::size_t count) {
  const Agreement sums = track_loops().agree(misses, count);
  return sums.stood >= 0.5 * sums.all && sums.left > kLeave * sums.stood;
}

void VelocityError::advance(const MotionField& told, double lasts) {
  if (!(told.dt_s() > 0)) return forget();
  const double speed_mps = told.displacement_C_m().norm() / told.dt_s();
  const double sigma = std::hypot(told.velocity_sigma_mps(), share_ * speed_mps);
  const double kept = sigma_mps_ > 0 ? lasts * std::min(1.0, sigma / sigma_mps_) : 0;
  const Eigen::Matrix3d F = kept * told.R_cur_prev();
  mean_mps_ = F * mean_mps_;
  covariance_ = F * covariance_ * F.transpose();
  covariance_.diagonal().array() += sigma * sigma - kept * kept * sigma_mps_ * sigma_mps_;
  sigma_mps_ = sigma;
}

Eigen::Vector3d VelocityError::update(const MotionFix& fix) {
  const Eigen::Vector3d before_mps = mean_mps_;
  mean_mps_ += fix.velocity_mps;
  covariance_ = fix.velocity_covariance;
  if (mean_mps_.norm() > kFar * sigma_mps_) mean_mps_.setZero();
  return mean_mps_ - before_mps;
}

}  // namespace lcs
