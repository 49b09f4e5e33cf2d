/// \file
/// Who stands where, on the plan from above: what overlaps, how near things come, what hides what.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace lcs::worlds {

/// An upright box about its heading.
struct Box {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();  ///< along its heading, and across
  double heading_rad = 0;
  double foot_m = 0, head_m = 0;  ///< heights of its lower and upper end
};

/// Free space between two boxes, seen from above; at most the true one, and below 0 where they
/// overlap. Boxes over each other are as far apart as can be.
double gap_m(const Box& a, const Box& b);

/// Whether a straight line goes through a box.
bool is_between(const Box& box, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m);

/// The point of a box that lies at these shares, from -1 to 1, of its sides.
Eigen::Vector3d point_of(const Box& box, double ahead, double left, double up);

/// Least gap to any of them; infinite without any.
double least_gap_m(const Box& box, const std::vector<Box>& others);

inline Eigen::Vector2d towards(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}
inline Eigen::Vector2d turned(const Eigen::Vector2d& v, double by_rad) {
  const Eigen::Vector2d d = towards(by_rad);
  return {d.x() * v.x() - d.y() * v.y(), d.y() * v.x() + d.x() * v.y()};
}

}  // namespace lcs::worlds
