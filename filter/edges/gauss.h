/// \file
/// Distances in standard deviations, log odds, and the number of rounds of iterations based on
/// them.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>

#include "filter/kinematics/camera.h"

namespace lcs {

/// Rounds of a fixed-point iteration.
inline constexpr int kIterations = 5;

/// Square of the distance in standard deviations (Mahalanobis).
inline double distance2(const Vec2& residual, const Eigen::Matrix2d& covariance) {
  return residual.dot(covariance.inverse() * residual);
}

/// Log odds ln(p / (1 - p)), and its inverse.
inline double log_odds(double chance) {
  return std::log(chance / (1 - chance));
}
inline double chance(double log_odds) {
  return 1 / (1 + std::exp(-log_odds));
}

}  // namespace lcs
