#include "filter/paper/tangent.h"

#include <algorithm>
#include <cmath>

namespace lcs::paper {
namespace {

/// Denominators below this, in units of the square's size, are treated as singular.
constexpr double kSingular = 1e-3;

/// Half sizes of the axis-parallel ellipse about `centre` that touches the line from O at `touch`.
std::optional<Vec2> touching_ellipse(const Vec2& centre, const Vec2& touch, const Vec2& origin,
                                     double scale) {
  const Vec2 o = origin - touch;  // O - L~_t
  const Vec2 c = touch - centre;  // L~_t - L~_s
  const double least = kSingular * scale;
  if (std::abs(o.x()) < least || std::abs(o.y()) < least || std::abs(c.x()) < least ||
      std::abs(c.y()) < least) {
    return std::nullopt;
  }
  const double ry2 = std::abs((o.x() * c.y() * c.y() - o.y() * c.x() * c.y()) / o.x());
  const double rx2 = std::abs(ry2 * o.x() * c.x() / (o.y() * c.y()));
  return Vec2(std::sqrt(rx2), std::sqrt(ry2));
}

}  // namespace

std::optional<std::pair<Vec2, Vec2>> tangent_points(const Extent& ellipse, const Vec2& origin) {
  if (ellipse.half_size.minCoeff() <= 0) return std::nullopt;
  // On the unit circle: the chord of contact is the polar of o.
  const Vec2 o = (origin - ellipse.location).cwiseQuotient(ellipse.half_size);
  const double o2 = o.squaredNorm();
  if (o2 <= 1) return std::nullopt;
  const Vec2 foot = o / o2;
  const Vec2 half_chord = std::sqrt(o2 - 1) / o2 * Vec2(-o.y(), o.x());
  return std::pair{Vec2(ellipse.location + ellipse.half_size.cwiseProduct(foot + half_chord)),
                   Vec2(ellipse.location + ellipse.half_size.cwiseProduct(foot - half_chord))};
}

std::optional<Extent> predict_by_tangents(const Extent& square, const Vec2& origin,
                                          double travelled_px) {
  const auto points = tangent_points(square, origin);
  if (!points) return std::nullopt;
  const double to_centre = (square.location - origin).norm();
  Extent predicted;
  predicted.location = square.location + travelled_px * (square.location - origin) / to_centre;
  if (to_centre + travelled_px <= 0) return std::nullopt;
  // Uses the touching point that is farther from the axes, as it is better conditioned.
  const auto conditioning = [&](const Vec2& t) {
    return (t - square.location).cwiseAbs().minCoeff();
  };
  const Vec2 touch =
      conditioning(points->first) >= conditioning(points->second) ? points->first : points->second;
  const double to_touch = (touch - origin).norm();
  const double d_r = (to_centre + travelled_px) * to_touch / to_centre - to_touch;
  // Equals m_t and the two printed equations for L~_t, with the sign that leads away from O.
  const Vec2 moved = touch + d_r * (touch - origin) / to_touch;
  const auto half_size =
      touching_ellipse(predicted.location, moved, origin, square.half_size.maxCoeff());
  if (!half_size) return std::nullopt;
  predicted.half_size = *half_size;
  return predicted;
}

Extent predict_by_homothety(const Extent& square, const Vec2& origin, double travelled_px) {
  const Vec2 ray = square.location - origin;
  const double distance = ray.norm();
  if (distance <= 0) return square;
  const double s = std::max(0.0, (distance + travelled_px) / distance);
  return {origin + s * ray, s * square.half_size};
}

}  // namespace lcs::paper
