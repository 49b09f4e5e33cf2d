#include "filter/circles/plane_evidence.h"

#include <Eigen/LU>
#include <cmath>

namespace lcs {

PlaneSums::PlaneSums(const Vec2& h, const Vec2& value, double sigma) {
  const double weight = 1 / (sigma * sigma);
  const Eigen::Vector3d x(1, h.x(), h.y());
  squares_ = weight * x * x.transpose();
  products_ = weight * x * value.transpose();
  values2_ = weight * value.squaredNorm();
}

PlaneSums& PlaneSums::operator+=(const PlaneSums& other) {
  squares_ += other.squares_;
  products_ += other.products_;
  values2_ += other.values2_;
  return *this;
}

double PlaneSums::evidence(const PlanePrior& prior, int values) const {
  // About the middle of the places, for there a level is expected; and less what is expected.
  Eigen::Matrix3d centred = Eigen::Matrix3d::Identity();
  centred.block<2, 1>(1, 0) = -squares_.block<2, 1>(1, 0) / squares_(0, 0);
  const Eigen::Matrix3d S = centred * squares_ * centred.transpose();
  const PlaneCoefficients left = products_ - squares_ * prior.mean;
  const PlaneCoefficients T = centred * left;
  const double left2 = values2_ - (prior.mean.array() * (products_ + left).array()).sum();
  const Eigen::Vector3d P(1 / (prior.level_sigma * prior.level_sigma),
                          1 / (prior.slope_sigma * prior.slope_sigma),
                          1 / (prior.slope_sigma * prior.slope_sigma));
  Eigen::Matrix3d A = S;
  A.diagonal() += P;
  const double explained = (T.array() * (A.inverse() * T).array()).sum();
  return -0.5 * (left2 - explained) - 0.5 * values * std::log(A.determinant() / P.prod());
}

}  // namespace lcs
