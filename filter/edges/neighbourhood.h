/// \file
/// The nearest corners of each corner of a frame, found once for all steps that ask.
#pragma once

#include <cmath>
#include <limits>
#include <span>
#include <vector>

#include "filter/matching/point_grid.h"

namespace lcs {

class Neighbourhood {
 public:
  /// \param cell_px about the distance of the neighbours, px.
  /// \param count neighbours of each point, fewer if there are fewer points.
  void build(std::span<const Vec2> points, double cell_px, int count) {
    grid_.build(points, cell_px);
    make_room(first_, points.size() + 1);
    make_room(nearest_, points.size() * static_cast<std::size_t>(count));
    first_.assign(1, 0);
    nearest_.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      grid_.nearest(
          points[i], std::numeric_limits<double>::infinity(), static_cast<std::size_t>(count),
          [&](int other) { return other != static_cast<int>(i); }, found_);
      nearest_.insert(nearest_.end(), found_.begin(), found_.end());
      first_.push_back(nearest_.size());
    }
  }

  const PointGrid& grid() const { return grid_; }
  /// The neighbours of a point, nearest first.
  std::span<const Neighbour> of(std::size_t point) const {
    return {nearest_.data() + first_[point], first_[point + 1] - first_[point]};
  }
  /// px: distance to the farthest of these neighbours; 0 without any.
  double reach_px(std::size_t point) const {
    return of(point).empty() ? 0 : std::sqrt(of(point).back().distance2);
  }

 private:
  PointGrid grid_;
  std::vector<Neighbour> found_, nearest_;
  std::vector<std::size_t> first_{0};
};

}  // namespace lcs
