/// \file
/// Geometry of the plan view: overlaps, gaps and occlusions.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <vector>

namespace lcs::worlds {

/// An upright box, rotated by its heading.
struct Box {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  Eigen::Vector2d half_m = Eigen::Vector2d::Zero();  ///< along its heading, and across
  double heading_rad = 0;
  double foot_m = 0, head_m = 0;  ///< heights of its bottom and top
};

/// Horizontal distance of two boxes: at most the true one, and below 0 for an overlap. Infinite
/// for boxes one above the other.
double gap_m(const Box& a, const Box& b);

/// Whether the line segment intersects the box.
bool is_between(const Box& box, const Eigen::Vector3d& from_m, const Eigen::Vector3d& to_m);

/// The point at these fractions, from -1 to 1, of a box's half sizes.
Eigen::Vector3d point_of(const Box& box, double ahead, double left, double up);

/// Least gap to any of the boxes; infinite without boxes.
double least_gap_m(const Box& box, const std::vector<Box>& others);

inline Eigen::Vector2d towards(double heading_rad) {
  return {std::cos(heading_rad), std::sin(heading_rad)};
}
inline Eigen::Vector2d turned(const Eigen::Vector2d& v, double by_rad) {
  const Eigen::Vector2d d = towards(by_rad);
  return {d.x() * v.x() - d.y() * v.y(), d.y() * v.x() + d.x() * v.y()};
}

}  // namespace lcs::worlds
