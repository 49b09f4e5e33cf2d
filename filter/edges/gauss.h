/// \file
/// Normal densities in the plane, 1/px^2, the normal distribution function, log odds, and the
/// number of rounds of iterations based on them.
#pragma once

#include <Eigen/Core>
#include <Eigen/LU>
#include <cmath>
#include <numbers>

#include "filter/kinematics/camera.h"

namespace lcs {

/// Rounds of a fixed-point iteration.
inline constexpr int kIterations = 5;

inline double gauss(const Vec2& residual, double variance) {
  return std::exp(-0.5 * residual.squaredNorm() / variance) / (2 * std::numbers::pi * variance);
}

/// Square of the distance in standard deviations (Mahalanobis).
inline double distance2(const Vec2& residual, const Eigen::Matrix2d& covariance) {
  return residual.dot(covariance.inverse() * residual);
}

inline double gauss(const Vec2& residual, const Eigen::Matrix2d& covariance) {
  return std::exp(-0.5 * distance2(residual, covariance)) /
         (2 * std::numbers::pi * std::sqrt(covariance.determinant()));
}

/// Probability that a standard normal variable is below z.
inline double below(double z) {
  return 0.5 * std::erfc(-z / std::numbers::sqrt2);
}

/// Log odds ln(p / (1 - p)), and its inverse.
inline double log_odds(double chance) {
  return std::log(chance / (1 - chance));
}
inline double chance(double log_odds) {
  return 1 / (1 + std::exp(-log_odds));
}

}  // namespace lcs
