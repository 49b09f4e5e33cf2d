/// \file
/// How well one plane explains what is measured at many places of the picture, by the evidence of
/// Bayesian linear regression: y = a + B h and noise, h = (x - c) / f, with a normal prior on a and
/// B about what is expected. The inverse depths of a flat body are such a plane, and so are the
/// image velocities of a rigid one, to first order.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "filter/kinematics/camera.h"

namespace lcs {

/// Coefficients of (1, h) for each of up to two measured values.
using PlaneCoefficients = Eigen::Matrix<double, 3, 2>;

/// What a plane is expected to be: coefficients, and standard deviations of a at the middle of what
/// is measured, and of each slope.
struct PlanePrior {
  PlaneCoefficients mean = PlaneCoefficients::Zero();
  double level_sigma = 1, slope_sigma = 1;
};

/// Sums over measurements, all that is needed of them. Additive: those of a group are the sum of
/// its members'.
class PlaneSums {
 public:
  PlaneSums() = default;
  /// One measurement. \param h its place. \param sigma of the noise of each value, > 0.
  PlaneSums(const Vec2& h, const Vec2& value, double sigma);

  PlaneSums& operator+=(const PlaneSums& other);

  /// How large what is measured is: the root of its weighed mean square.
  double magnitude() const { return std::sqrt(values2_ / squares_(0, 0)); }

  /// ln p(measurements | prior), but for what does not depend on the prior.
  /// \param values how many are measured at each place, 1 or 2; the second is 0 where it is one.
  double evidence(const PlanePrior& prior, int values) const;

 private:
  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();       // sum of q (1, h) (1, h)^T
  PlaneCoefficients products_ = PlaneCoefficients::Zero();  // sum of q (1, h) y^T
  double values2_ = 0;                                      // sum of q |y|^2
};

}  // namespace lcs
