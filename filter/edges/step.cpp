#include "filter/edges/step.h"

#include <algorithm>
#include <cmath>

#include "filter/edges/gauss.h"
#include "filter/kinematics/geometry.h"

namespace lcs {

Step::Step(const Vec2& step_px, const Vec2& parallax_px_m, const DepthBounds& bounds) {
  const double length = parallax_px_m.norm();
  const Vec2 direction = length > 1e-9 ? Vec2(parallax_px_m / length) : Vec2::UnitX();
  segment_px = (bounds.most_pm - bounds.least_pm) * length;
  farthest_px = bounds.least_pm * length;
  along_px = step_px.dot(direction) - farthest_px;
  across_px = cross(direction, step_px);
}

double Step::density_of_mover(double reach_px, double noise2_px2) const {
  const double a = along_px, s2 = across_px * across_px + 2 * noise2_px2, s = std::sqrt(s2);
  const double orders = std::log(1 + reach_px * reach_px / (2 * noise2_px2));
  return segment_px > 1e-6 * s
             ? (std::atan((segment_px - a) / s) + std::atan(a / s)) /
                   (segment_px * kPi * orders * s)
             : 1 / (kPi * orders * (s2 + (a - segment_px / 2) * (a - segment_px / 2)));
}

double Step::density_of_crossing(double slide, double step_variance_px2) const {
  if (!(segment_px > 1e-6)) return 0;  // without parallax nothing slides
  const double nearest = std::clamp(along_px, 0.0, segment_px);
  const double off2 = across_px * across_px + (along_px - nearest) * (along_px - nearest);
  const double way = slide * (farthest_px + nearest), s2 = way * way + step_variance_px2;
  return std::exp(-0.5 * off2 / s2) / (std::sqrt(2 * kPi * s2) * segment_px);
}

}  // namespace lcs
