#include "scenes/worlds/kit.h"

#include <algorithm>
#include <limits>

namespace lcs::worlds {
namespace {

/// Half extent of a box along a direction.
double reach(const TurnedBox& box, const Vector2d& along) {
  const Vector2d ahead = towards(box.heading_rad), left(-ahead.y(), ahead.x());
  return box.half_m.x() * std::abs(along.dot(ahead)) + box.half_m.y() * std::abs(along.dot(left));
}

}  // namespace

double gap_m(const TurnedBox& a, const TurnedBox& b) {
  if (a.foot_m >= b.head_m || b.foot_m >= a.head_m) return std::numeric_limits<double>::infinity();
  const Vector2d between = b.centre_m - a.centre_m;
  double gap = -std::numeric_limits<double>::infinity();
  const auto try_axis = [&](const Vector2d& axis) {
    gap = std::max(gap, std::abs(between.dot(axis)) - reach(a, axis) - reach(b, axis));
  };
  for (const TurnedBox* box : {&a, &b}) {
    const Vector2d ahead = towards(box->heading_rad);
    try_axis(ahead);
    try_axis({-ahead.y(), ahead.x()});
  }
  return gap;
}

bool is_between(const TurnedBox& box, const Vector3d& from_m, const Vector3d& to_m) {
  const auto in_box = [&](const Vector3d& p) {
    const Vector2d flat = turned(p.head<2>() - box.centre_m, -box.heading_rad);
    return Vector3d(flat.x(), flat.y(), p.z());
  };
  const Vector3d from = in_box(from_m), way = in_box(to_m) - from;
  const Vector3d low(-box.half_m.x(), -box.half_m.y(), box.foot_m);
  const Vector3d high(box.half_m.x(), box.half_m.y(), box.head_m);
  double first = 0, last = 1;
  for (int i = 0; i < 3; ++i) {
    if (way[i] == 0) {
      if (from[i] < low[i] || from[i] > high[i]) return false;
      continue;
    }
    const double a = (low[i] - from[i]) / way[i], b = (high[i] - from[i]) / way[i];
    first = std::max(first, std::min(a, b));
    last = std::min(last, std::max(a, b));
  }
  return first < last;
}

Vector3d point_of(const TurnedBox& box, double ahead, double left, double up) {
  const Vector2d flat =
      box.centre_m + turned({ahead * box.half_m.x(), left * box.half_m.y()}, box.heading_rad);
  return {flat.x(), flat.y(), (box.foot_m + box.head_m) / 2 + up * (box.head_m - box.foot_m) / 2};
}

std::array<Vector2d, 4> corners_of(const TurnedBox& box) {
  std::array<Vector2d, 4> corners;
  auto corner = corners.begin();
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) *corner++ = point_of(box, x, y, 0).head<2>();
  }
  return corners;
}

bool is_within(const TurnedBox& box, const Vector2d& low_m, const Vector2d& high_m) {
  return std::ranges::all_of(corners_of(box), [&](const Vector2d& corner) {
    return (corner.array() >= low_m.array()).all() && (corner.array() <= high_m.array()).all();
  });
}

double least_gap_m(const TurnedBox& box, const std::vector<TurnedBox>& others) {
  double least = std::numeric_limits<double>::infinity();
  for (const TurnedBox& other : others) least = std::min(least, gap_m(box, other));
  return least;
}

}  // namespace lcs::worlds
