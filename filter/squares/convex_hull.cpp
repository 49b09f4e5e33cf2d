#include "filter/squares/convex_hull.h"

#include <algorithm>
#include <tuple>

#include "filter/kinematics/geometry.h"

namespace lcs {

std::pair<Vec2, Vec2> ConvexHull::box() const {
  Vec2 low = points_.front(), high = low;
  for (const Vec2& point : points_) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  return {low, high};
}

/// From the leftmost point along the upper side to the rightmost, back along the lower side.
void ConvexHull::make_chain() {
  std::ranges::sort(points_, {}, [](const Vec2& x) { return std::tuple(x.x(), x.y()); });
  points_.erase(std::unique(points_.begin(), points_.end()), points_.end());
  chain_.clear();
  if (chain_.capacity() < points_.size() + 1) chain_.reserve(points_.capacity() + 1);
  // All turns are clockwise in the picture.
  const auto add = [&](const Vec2& point, std::size_t first) {
    while (chain_.size() >= first + 2 &&
           !(cross(chain_.back() - chain_[chain_.size() - 2], point - chain_.back()) > 0)) {
      chain_.pop_back();
    }
    chain_.push_back(point);
  };
  for (const Vec2& point : points_) add(point, 0);
  if (points_.size() < 2) return;
  const std::size_t rightmost = chain_.size() - 1;
  for (auto point = points_.rbegin() + 1; point != points_.rend(); ++point) add(*point, rightmost);
  chain_.pop_back();  // the first point, repeated
}

Outline ConvexHull::outline() {
  make_chain();
  Outline outline;
  if (std::ssize(chain_) <= Outline::kMost) {
    std::ranges::copy(chain_, outline.places.begin());
    outline.count = static_cast<int>(chain_.size());
    return outline;
  }
  // Directions and vertices turn alike: a repeated farthest vertex is the last or the first one.
  for (int k = 0; k < Outline::kMost; ++k) {
    const Vec2 direction = unit_vector(kPi * (2.0 * k / Outline::kMost - 1));
    const Vec2& farthest = *std::ranges::max_element(
        chain_, [&](const Vec2& a, const Vec2& b) { return a.dot(direction) < b.dot(direction); });
    const auto is_last = [&](int i) {
      return outline.places[static_cast<std::size_t>(i)] == farthest;
    };
    if (outline.count > 0 && (is_last(outline.count - 1) || is_last(0))) continue;
    outline.places[static_cast<std::size_t>(outline.count++)] = farthest;
  }
  return outline;
}

double beyond(std::size_t count) {
  return static_cast<double>(count + 1) / static_cast<double>(std::max<std::size_t>(count, 2) - 1);
}

void place(Square& square, const Vec2& location, const Vec2& half_size) {
  const Vec2 stretch = (square.half_size.array() > 0)
                           .select(half_size.array() / square.half_size.array(), 1.0)
                           .matrix();
  for (Vec2& vertex : square.outline.vertices()) {
    vertex = location + (vertex - square.location).cwiseProduct(stretch);
  }
  square.location = location;
  square.half_size = half_size;
}

}  // namespace lcs
