#include "tools/scoring/region.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>
#include <tuple>

namespace lcs::scoring {
namespace {

constexpr double kRim_px = 1e-6;
constexpr double kFarthest_px = 1 << 15;  // twice a picture's longest side

int first_pixel(double x) {
  return static_cast<int>(std::ceil(std::clamp(x, -kFarthest_px, kFarthest_px) - kRim_px));
}
int last_pixel(double x) {
  return static_cast<int>(std::floor(std::clamp(x, -kFarthest_px, kFarthest_px) + kRim_px));
}

void add(Region& region, const Stretch& stretch) {
  if (stretch.bottom <= stretch.top) return;
  region.stretches.push_back(stretch);
  region.pixels += stretch.bottom - stretch.top;
}

}  // namespace

Region region_of(const sim::Mask& mask) {
  Region region;
  sim::visit_stretches(mask, [&](int column, int top, int bottom) {
    add(region, {column, top, bottom});
  });
  return region;
}

Region region_of(const Outline& outline) {
  const std::span<const Vec2> polygon = outline.vertices();
  double left = std::numeric_limits<double>::infinity(), right = -left;
  for (const Vec2& point : polygon) {
    left = std::min(left, point.x());
    right = std::max(right, point.x());
  }
  Region region;
  if (polygon.empty()) return region;
  for (int column = first_pixel(left); column <= last_pixel(right); ++column) {
    double top = std::numeric_limits<double>::infinity(), bottom = -top;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const Vec2 &a = polygon[i], &b = polygon[(i + 1) % polygon.size()];
      if (column < std::min(a.x(), b.x()) - kRim_px || column > std::max(a.x(), b.x()) + kRim_px) {
        continue;
      }
      const double wide = b.x() - a.x();
      const auto y_at = [&](double share) { return a.y() + share * (b.y() - a.y()); };
      // A vertical side lies in the column with its whole length.
      const bool is_upright = std::abs(wide) <= kRim_px;
      const double there = is_upright ? 0 : std::clamp((column - a.x()) / wide, 0.0, 1.0);
      for (const double y : {y_at(there), y_at(is_upright ? 1 : there)}) {
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
    }
    add(region, {column, first_pixel(top), last_pixel(bottom) + 1});
  }
  return region;
}

Region region_of(const recording::Box& box) {
  Region region;
  for (int column = first_pixel(box.min().x()); column <= last_pixel(box.max().x()); ++column) {
    add(region, {column, first_pixel(box.min().y()), last_pixel(box.max().y()) + 1});
  }
  return region;
}

Region region_of(const Square& square, const recording::SquareMasks& masks) {
  if (const auto mask = masks.find(square.id); mask != masks.end()) return region_of(mask->second);
  return square.outline.count > 0 ? region_of(square.outline)
                                  : region_of(recording::box_of(square));
}

double intersection_over_union(const Region& a, const Region& b) {
  std::int64_t common = 0;
  for (auto i = a.stretches.begin(), j = b.stretches.begin();
       i != a.stretches.end() && j != b.stretches.end();) {
    if (i->column == j->column) {
      common += std::max(0, std::min(i->bottom, j->bottom) - std::max(i->top, j->top));
    }
    ++(std::tuple(i->column, i->bottom) < std::tuple(j->column, j->bottom) ? i : j);
  }
  const std::int64_t all = a.pixels + b.pixels - common;
  return all > 0 ? static_cast<double>(common) / static_cast<double>(all) : 0;
}

}  // namespace lcs::scoring
