/// \file
/// The nearest corners of each corner of a frame, found once for all steps that ask.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
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
    const std::size_t others = std::max<std::size_t>(points.size(), 1) - 1;
    count_ = std::min(static_cast<std::size_t>(count), others);
    make_room(nearest_, points.size() * static_cast<std::size_t>(count));
    nearest_.resize(points.size() * count_);
    refill_column(ranks_, points.size());
    if (count_ == 0) return;
    double radius_px = grid_.crowd_radius(points[grid_.index_at(0)], count);
    for (std::size_t place = 0; place < points.size(); ++place) {
      const int here = grid_.index_at(place);
      const Vec2& x = points[here];
      // It reaches about as far as the last one.
      if (place > 0) radius_px = 1.2 * reach_px(grid_.index_at(place - 1));
      std::size_t near = grid_.find_within(x, radius_px, near_);
      for (; near <= count_; near = grid_.find_within(x, radius_px, near_)) radius_px *= 1.4;
      const auto self = std::ranges::find(near_.places, static_cast<int>(place));
      near_.distance2_px2[static_cast<std::size_t>(self - near_.places.begin())] = -1;  // the least
      loops().ranks(near_.distance2_px2.data(), near, ranks_.data());
      Neighbour* const nearest = &nearest_[static_cast<std::size_t>(here) * count_];
      for (std::size_t k = 0; k < near; ++k) {
        const auto rank = static_cast<std::size_t>(ranks_[k]);
        if (rank == 0 || rank > count_) continue;
        nearest[rank - 1] = {near_.distance2_px2[k],
                             grid_.index_at(static_cast<std::size_t>(near_.places[k]))};
      }
    }
  }

  const PointGrid& grid() const { return grid_; }
  /// The neighbours of a point, nearest first; equally near ones in the order of the grid.
  std::span<const Neighbour> of(std::size_t point) const {
    return {nearest_.data() + point * count_, count_};
  }
  /// The neighbours of all points, point by point; the same number for each point.
  std::span<const Neighbour> all() const { return nearest_; }
  /// px: distance to the farthest of these neighbours; 0 without any.
  double reach_px(std::size_t point) const {
    return count_ == 0 ? 0 : std::sqrt(of(point).back().distance2);
  }

 private:
  PointGrid grid_;
  PointGrid::Found near_;
  std::vector<int> ranks_;          // of these
  std::vector<Neighbour> nearest_;  // `count_` of each point
  std::size_t count_ = 0;
};

}  // namespace lcs
