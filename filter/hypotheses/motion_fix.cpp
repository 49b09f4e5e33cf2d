#include "filter/hypotheses/motion_fix.h"

#include <Eigen/LU>

#include "filter/hypotheses/gauss.h"

namespace lcs {
namespace {

constexpr std::size_t kLeastResiduals = 20;
constexpr int kIterations = 4;
/// Standard deviations of what is told, on an axis, before anything is seen: of the turn within a
/// frame, and of the velocity of a camera that stands.
constexpr double kTurn_rad = 1e-3;
constexpr double kStill_mps = 0.003;
/// What a residual counts for: those of one body are off together.
constexpr double kOwnVoice = 0.05;

using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Vector6 = Eigen::Matrix<double, 6, 1>;

/// px per rad and m/s: the image motion by a small turn and a change of velocity, first order.
Eigen::Matrix<double, 2, 6> jacobian(const Intrinsics& camera, const Residual& residual,
                                     double dt_s) {
  const Vec2 h = (residual.place_px - camera.centre_px) / camera.focal_px;
  Eigen::Matrix<double, 2, 6> J;
  J.leftCols<3>() << h.x() * h.y(), -(1 + h.x() * h.x()), h.y(), 1 + h.y() * h.y(), -h.x() * h.y(),
      -h.x();
  J.rightCols<3>() << -1, 0, h.x(), 0, -1, h.y();
  J.rightCols<3>() *= residual.inverse_depth_pm * dt_s;
  return camera.focal_px * J;
}

}  // namespace

/// Normal equations, each residual weighed by the chance that it is of a static point, given what
/// is left of it and how well the fix is known by then.
MotionFix motion_fix(const Intrinsics& camera, const MotionField& told,
                     std::span<const Residual> residuals, double ego_share) {
  if (residuals.size() < kLeastResiduals) return {};
  const double dt = told.dt_s();
  const double drift = ego_share * told.displacement_C_m().norm() / dt;
  const double velocity_variance = kStill_mps * kStill_mps + drift * drift;
  Matrix6 covariance = Matrix6::Zero();
  covariance.diagonal() << Eigen::Vector3d::Constant(kTurn_rad * kTurn_rad),
      Eigen::Vector3d::Constant(velocity_variance);
  const Matrix6 prior = covariance.diagonal().cwiseInverse().asDiagonal();
  Vector6 fix = Vector6::Zero();
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Matrix6 information = prior;
    Vector6 pull = Vector6::Zero();
    for (const Residual& residual : residuals) {
      const Eigen::Matrix<double, 2, 6> J = jacobian(camera, residual, dt);
      // How far a change of velocity moves a point is as uncertain as its depth.
      Eigen::Matrix2d S = residual.covariance_px2;
      S.diagonal().array() += camera.focal_px * camera.focal_px * dt * dt * velocity_variance *
                              residual.inverse_depth_variance_pm2;
      const Vec2 left = residual.off_px - J * fix;
      const double stands = residual.stands * gauss(left, S + J * covariance * J.transpose());
      const Eigen::Matrix<double, 6, 2> weighed =
          kOwnVoice * stands / (stands + residual.otherwise_ppx2) * J.transpose() * S.inverse();
      information += weighed * J;
      pull += weighed * residual.off_px;
    }
    covariance = information.inverse();
    fix = covariance * pull;
  }
  return {fix.head<3>(), fix.tail<3>()};
}

}  // namespace lcs
