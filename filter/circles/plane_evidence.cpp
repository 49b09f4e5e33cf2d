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
  return values == 1 ? evidence_of<1>(prior) : evidence_of<2>(prior);
}

template <int kValues>
double PlaneSums::evidence_of(const PlanePrior& prior) const {
  using Coefficients = Eigen::Matrix<double, 3, kValues>;
  const Coefficients products = products_.leftCols<kValues>(),
                     mean = prior.mean.leftCols<kValues>();
  // Relative to the prior mean and to the centroid of the places, where the level's prior holds.
  // There level and slopes are uncorrelated.
  const double count = squares_(0, 0);
  const Vec2 middle = squares_.block<2, 1>(1, 0) / count;
  const Coefficients left = products - squares_ * mean;
  const double left2 = values2_ - (mean.array() * (products + left).array()).sum();
  const Eigen::Matrix<double, 2, kValues> T = left.template bottomRows<2>() - middle * left.row(0);
  const double level_P = 1 / (prior.level_sigma * prior.level_sigma);
  const double slope_P = 1 / (prior.slope_sigma * prior.slope_sigma);
  Eigen::Matrix2d A = squares_.bottomRightCorner<2, 2>() - count * middle * middle.transpose();
  A.diagonal().array() += slope_P;
  const double level_A = count + level_P;
  const double explained =
      left.row(0).squaredNorm() / level_A + (T.array() * (A.inverse() * T).array()).sum();
  return -0.5 * (left2 - explained) -
         0.5 * kValues * std::log(level_A * A.determinant() / (level_P * slope_P * slope_P));
}

}  // namespace lcs
