/// \file
/// Neighbours of a point among many: a uniform grid that is rebuilt each frame into the same
/// memory.
#pragma once

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

#include "filter/camera.h"

namespace lcs {

/// Points are finite; they are referred to by their index.
class PointGrid {
 public:
  /// \param cell_px about the radius that will be asked for, > 0.
  void build(std::span<const Vec2> points, double cell_px) {
    points_.assign(points.begin(), points.end());
    low_ = Vec2::Zero();
    Vec2 high = Vec2::Zero();
    if (!points_.empty()) {
      low_ = high = points_.front();
      for (const Vec2& x : points_) {
        low_ = low_.cwiseMin(x);
        high = high.cwiseMax(x);
      }
    }
    // Cells grow rather than their number when points lie far apart.
    cell_px_ = std::max(cell_px, (high - low_).maxCoeff() / kMaxSide);
    columns_ = 1 + static_cast<int>((high.x() - low_.x()) / cell_px_);
    rows_ = 1 + static_cast<int>((high.y() - low_.y()) / cell_px_);

    // Counting sort of the points into their cells.
    first_.assign(static_cast<std::size_t>(columns_) * rows_ + 1, 0);
    for (const Vec2& x : points_) ++first_[cell(column(x.x()), row(x.y())) + 1];
    for (std::size_t c = 1; c < first_.size(); ++c) first_[c] += first_[c - 1];
    order_.resize(points_.size());
    next_.assign(first_.begin(), first_.end() - 1);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      const std::size_t c = cell(column(points_[i].x()), row(points_[i].y()));
      order_[next_[c]++] = static_cast<int>(i);
    }
  }

  /// Calls `visit(index, squared distance)` for each point within `radius_px` of x.
  template <typename Visit>
  void visit_within(const Vec2& x, double radius_px, Visit&& visit) const {
    const int c0 = column(x.x() - radius_px), c1 = column(x.x() + radius_px);
    const int r0 = row(x.y() - radius_px), r1 = row(x.y() + radius_px);
    for (int r = r0; r <= r1; ++r) {
      for (std::size_t k = first_[cell(c0, r)]; k < first_[cell(c1, r) + 1]; ++k) {
        const double distance2 = (points_[order_[k]] - x).squaredNorm();
        if (distance2 <= radius_px * radius_px) visit(order_[k], distance2);
      }
    }
  }

 private:
  static constexpr double kMaxSide = 512;

  int column(double x) const { return clamped((x - low_.x()) / cell_px_, columns_); }
  int row(double y) const { return clamped((y - low_.y()) / cell_px_, rows_); }
  static int clamped(double cells, int count) {
    return static_cast<int>(std::clamp(std::floor(cells), 0.0, static_cast<double>(count - 1)));
  }
  std::size_t cell(int c, int r) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(c);
  }

  std::vector<Vec2> points_;
  std::vector<std::size_t> first_{0, 0};  // of each cell in order_, and the end
  std::vector<std::size_t> next_;
  std::vector<int> order_;
  Vec2 low_ = Vec2::Zero();
  double cell_px_ = 1;
  int columns_ = 1, rows_ = 1;
};

}  // namespace lcs
