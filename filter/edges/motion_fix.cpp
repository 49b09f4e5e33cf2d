#include "filter/edges/motion_fix.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>

#include "filter/edges/gauss.h"
#include "filter/matching/point_grid.h"
#include "filter/vectors/refill.h"
#include "filter/vectors/vectors.h"

namespace lcs {
namespace {

/// Prior standard deviation of the error of a frame's given rotation, on each axis.
constexpr double kTurn_rad = 1e-3;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// Lower triangle of a Cholesky factor, row by row; zeros where the matrix is singular.
std::array<double, 21> root_of(const Matrix6& covariance) {
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
  return root;
}

}  // namespace

/// Puts the residuals into columns.
void MotionFinder::place(const Intrinsics& camera, const MotionField& told,
                         std::span<const Residual> residuals, double velocity_variance_m2ps2) {
  const double dt = told.dt_s(), per_depth_px_m = camera.focal_px * dt;
  const std::array columns = {&h_x_,      &h_y_,      &motion_s_,      &off_x_px_,
                              &off_y_px_, &S_xx_px2_, &S_xy_px2_,      &S_yy_px2_,
                              &voice_,    &stands_,   &otherwise_ppx2_};
  for (std::vector<double>* column : columns) {
    column->clear();
    make_room(*column, residuals.size() + kLanes);
  }
  for (const Residual& residual : residuals) {
    // The effect of a change of velocity on a point is as uncertain as the point's depth.
    Eigen::Matrix2d S =
        residual.covariance_px2 + residual.by_depth_px * residual.by_depth_px.transpose();
    S.diagonal().array() += per_depth_px_m * per_depth_px_m * velocity_variance_m2ps2 *
                            residual.inverse_depth_variance_pm2;
    // The precision across a segment of a million pixels is lost in rounding.
    if (!(S.determinant() > 1e-12 * S.trace() * S.trace())) continue;
    const Vec2 h = (residual.place_px - camera.centre_px) / camera.focal_px;
    h_x_.push_back(h.x());
    h_y_.push_back(h.y());
    motion_s_.push_back(residual.inverse_depth_pm * dt);
    off_x_px_.push_back(residual.off_px.x());
    off_y_px_.push_back(residual.off_px.y());
    S_xx_px2_.push_back(S(0, 0));
    S_xy_px2_.push_back(S(0, 1));
    S_yy_px2_.push_back(S(1, 1));
    voice_.push_back(residual.voice);
    stands_.push_back(residual.stands);
    otherwise_ppx2_.push_back(residual.otherwise_ppx2);
  }
  for (std::vector<double>* column : columns) {
    const bool is_variance = column == &S_xx_px2_ || column == &S_yy_px2_;
    column->resize(column->size() + kLanes, is_variance || column == &otherwise_ppx2_ ? 1 : 0);
  }
}

MotionFix MotionFinder::find(const Intrinsics& camera, const MotionField& told,
                             std::span<const Residual> residuals,
                             const Eigen::Matrix3d& velocity_covariance) {
  const double turn = std::hypot(kTurn_rad, told.unseen_turn_rad());
  Matrix6 prior = Matrix6::Zero();  // not inverted: 0 if the motion is exact
  prior.topLeftCorner<3, 3>().diagonal().setConstant(turn * turn);
  prior.bottomRightCorner<3, 3>() = velocity_covariance;
  place(camera, told, residuals, velocity_covariance.trace() / 3);
  const ResidualColumns columns = {
      h_x_.data(),      h_y_.data(),      motion_s_.data(),       off_x_px_.data(),
      off_y_px_.data(), S_xx_px2_.data(), S_xy_px2_.data(),       S_yy_px2_.data(),
      voice_.data(),    stands_.data(),   otherwise_ppx2_.data(), camera.focal_px};
  Matrix6 left_open = prior, covariance = prior;
  Vector6 fix = Vector6::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    NormalSums sums;
    loops().normal_sums(columns, h_x_.size() - kLanes, fix.data(), root_of(left_open).data(), sums);
    Matrix6 information;
    for (int row = 0, entry = 0; row < 6; ++row) {
      for (int column = row; column < 6; ++column, ++entry) {
        information(row, column) = information(column, row) = sums.information[entry];
      }
    }
    covariance = (Matrix6::Identity() + prior * information).inverse() * prior;
    fix = covariance * Eigen::Map<const Vector6>(sums.pull);
    // Wrong matches pull the first rounds far off; later rounds search closer.
    left_open = covariance + prior * std::pow(kFar, -2 * (iteration + 1));
  }
  // Places of a billion focal lengths overflow: then nothing is known about the motion.
  if (!fix.allFinite() || !covariance.allFinite()) {
    return {Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero(), velocity_covariance};
  }
  return {fix.head<3>(), fix.tail<3>(), covariance.bottomRightCorner<3, 3>()};
}

bool is_contradicted(std::span<const Residual> residuals) {
  double left = 0, stood = 0, all = 0;
  for (const Residual& residual : residuals) {
    const double stands = residual.stands * gauss(residual.off_px, residual.covariance_px2);
    left += residual.voice * residual.stands * residual.otherwise_ppx2 /
            (stands + residual.otherwise_ppx2);
    stood += residual.voice * residual.stands;
    all += residual.voice;
  }
  return stood >= 0.5 * all && left > kLeave * stood;
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
