#include "filter/hypotheses/rotation_fix.h"

#include <Eigen/Cholesky>

namespace lcs {
namespace {

constexpr std::size_t kLeastResiduals = 20;
constexpr int kIterations = 3;
/// rad: standard deviation of what a rotation is off by about an axis, before anything is seen.
constexpr double kPrior_rad = 1e-3;

/// px/rad: the image motion by a small rotation, first order.
Eigen::Matrix<double, 2, 3> jacobian(const Intrinsics& camera, const Vec2& x_px) {
  const Vec2 h = (x_px - camera.centre_px) / camera.focal_px;
  Eigen::Matrix<double, 2, 3> J;
  J << h.x() * h.y(), -(1 + h.x() * h.x()), h.y(), 1 + h.y() * h.y(), -h.x() * h.y(), -h.x();
  return camera.focal_px * J;
}

}  // namespace

Vec2 shift(const Intrinsics& camera, const Eigen::Vector3d& rotation_rad, const Vec2& x_px) {
  return jacobian(camera, x_px) * rotation_rad;
}

Eigen::Vector3d rotation_fix(const Intrinsics& camera, std::span<const Residual> residuals,
                             double noise2_px2) {
  Eigen::Vector3d rotation = Eigen::Vector3d::Zero();
  if (residuals.size() < kLeastResiduals) return rotation;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix3d A = Eigen::Matrix3d::Identity() / (kPrior_rad * kPrior_rad);
    Eigen::Vector3d b = Eigen::Vector3d::Zero();
    for (const Residual& residual : residuals) {
      const Eigen::Matrix<double, 2, 3> J = jacobian(camera, residual.place_px);
      const Vec2 left = residual.off_px - J * rotation;
      const double weight = 1 / (noise2_px2 + left.squaredNorm() / 4);
      A += weight * J.transpose() * J;
      b += weight * J.transpose() * residual.off_px;
    }
    rotation = A.ldlt().solve(b);
  }
  return rotation;
}

}  // namespace lcs
