/// \file
/// Evidence (marginal likelihood) that one plane explains measurements at many image places, by
/// Bayesian linear regression: y = a + B h + noise, h = (x - c) / f, with a normal prior on a and
/// B. Inverse depths of a flat body form such a plane. So do image velocities of a rigid body, to
/// first order.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include "filter/kinematics/camera.h"

namespace lcs {

/// Coefficients of (1, h) for each of up to two measured values.
using PlaneCoefficients = Eigen::Matrix<double, 3, 2>;

/// Prior of a plane: mean coefficients, standard deviation of the level a at the centroid of the
/// measurements, and of each slope.
struct PlanePrior {
  PlaneCoefficients mean = PlaneCoefficients::Zero();
  double level_sigma = 1, slope_sigma = 1;
};

/// Sufficient statistics of measurements. Additive: a group's are the sum of its members'.
class PlaneSums {
 public:
  PlaneSums() = default;
  /// One measurement. \param h its place. \param sigma of the noise of each value, > 0.
  PlaneSums(const Vec2& h, const Vec2& value, double sigma);

  PlaneSums& operator+=(const PlaneSums& other);

  /// Weighted root mean square of the measured values.
  double magnitude() const { return std::sqrt(values2_ / squares_(0, 0)); }

  /// ln p(measurements | prior), without the terms that do not depend on the prior.
  /// \param values number of values at each place, 1 or 2; the second is 0 if there is one.
  double evidence(const PlanePrior& prior, int values) const;

 private:
  template <int kValues>
  double evidence_of(const PlanePrior& prior) const;

  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();       // sum of q (1, h) (1, h)^T
  PlaneCoefficients products_ = PlaneCoefficients::Zero();  // sum of q (1, h) y^T
  double values2_ = 0;                                      // sum of q |y|^2
};

}  // namespace lcs
