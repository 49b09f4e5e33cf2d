/// \file
/// Neighbour search in a uniform grid. It is rebuilt each frame in the same memory.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <span>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/vectors/refill.h"
#include "filter/vectors/vectors.h"

namespace lcs {

/// A search visits about this many points, so that a frame's time is linear in its points.
inline constexpr std::size_t kCrowd = 60;

/// Search radius in standard deviations; the normal density's factor there is 0.011.
inline constexpr double kFar = 3;

/// A point found near another. Sorted by distance, then index. Hand-written, as comparisons of
/// std::pair and std::tuple compare doubles twice.
struct Neighbour {
  double distance2;  ///< px^2
  int index;
  bool operator<(const Neighbour& other) const {
    return distance2 < other.distance2 || (distance2 == other.distance2 && index < other.index);
  }
};

/// Points must be finite. They are identified by index.
class PointGrid {
 public:
  /// \param cell_px about the search radius, px; raised to at least 1.
  void build(std::span<const Vec2> points, double cell_px) {
    low_ = Vec2::Zero();
    Vec2 high = Vec2::Zero();
    if (!points.empty()) {
      low_ = high = points.front();
      for (const Vec2& x : points) {
        low_ = low_.cwiseMin(x);
        high = high.cwiseMax(x);
      }
    }
    // If points lie far apart, cells grow; their number does not.
    cell_px_ = std::max({cell_px, 1.0, (high - low_).maxCoeff() / kMaxSide});
    columns_ = 1 + static_cast<int>((high.x() - low_.x()) / cell_px_);
    rows_ = 1 + static_cast<int>((high.y() - low_.y()) / cell_px_);

    // Counting sort of the points into cells: first_[c + 1] advances from the start of cell c to
    // its end, which is the start of the next cell.
    refill(first_, static_cast<std::size_t>(columns_) * rows_ + 2);
    refill(cell_of_, points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      cell_of_[i] = cell(column(points[i].x()), row(points[i].y()));
      ++first_[cell_of_[i] + 2];
    }
    for (std::size_t c = 2; c < first_.size(); ++c) first_[c] += first_[c - 1];
    refill(placed_, points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      placed_[first_[cell_of_[i] + 1]++] = {points[i], static_cast<int>(i)};
    }
    refill_column(x_px_, points.size());
    refill_column(y_px_, points.size());
    for (std::size_t place = 0; place < placed_.size(); ++place) {
      x_px_[place] = static_cast<float>(placed_[place].location.x());
      y_px_[place] = static_cast<float>(placed_[place].location.y());
    }
  }

  std::size_t size() const { return placed_.size(); }

  /// The points in the order of the cells, as padded columns for `Loops`.
  const float* x_px() const { return x_px_.data(); }
  const float* y_px() const { return y_px_.data(); }

  /// Index of the point at a place in the order of the cells.
  int index_at(std::size_t place) const { return placed_[place].index; }

  /// Places of points and their squared distances from another, px^2; room for a search.
  struct Found {
    std::vector<int> places;
    std::vector<float> distance2_px2;
  };

  /// Finds the points within `radius_px` of x, px, in single precision. \return their number.
  std::size_t find_within(const Vec2& x, double radius_px, Found& found) const {
    const std::size_t room = placed_.size() + kLanes;
    if (found.places.size() < room) {
      refill(found.places, room);
      refill(found.distance2_px2, room);
    }
    std::size_t count = 0;
    visit_runs(x, radius_px, [&](std::size_t first, std::size_t last) {
      count += loops().within(x_px_.data(), y_px_.data(), first, last, static_cast<float>(x.x()),
                              static_cast<float>(x.y()), static_cast<float>(radius_px * radius_px),
                              found.places.data() + count, found.distance2_px2.data() + count);
    });
    return count;
  }
  /// The number of points within `radius_px` of x, px, in single precision.
  std::size_t count_within(const Vec2& x, double radius_px) const {
    std::size_t count = 0;
    visit_runs(x, radius_px, [&](std::size_t first, std::size_t last) {
      count += loops().count_within(x_px_.data(), y_px_.data(), first, last,
                                    static_cast<float>(x.x()), static_cast<float>(x.y()),
                                    static_cast<float>(radius_px * radius_px));
    });
    return count;
  }

  /// Calls `visit(first, last)` for ranges of places in the order of the cells that hold all points
  /// within `radius_px` of x, px, and few others.
  template <typename Visit>
  void visit_runs(const Vec2& x, double radius_px, Visit&& visit) const {
    visit_rows(row(x.y() - radius_px), x, radius_px, visit);
  }

  /// Calls `visit(index, squared distance)` for each point within `radius_px` of x, px.
  template <typename Visit>
  void visit_within(const Vec2& x, double radius_px, Visit&& visit) const {
    const double radius2 = radius_px * radius_px;
    // Filters in batches without a branch, which would often be mispredicted.
    std::array<Neighbour, 32> near;
    visit_runs(x, radius_px, [&](std::size_t first, std::size_t last) {
      while (first < last) {
        const std::size_t end = std::min(last, first + near.size());
        std::size_t count = 0;
        for (; first < end; ++first) {
          const double distance2 = (placed_[first].location - x).squaredNorm();
          near[count] = {distance2, placed_[first].index};
          count += distance2 <= radius2;
        }
        for (std::size_t i = 0; i < count; ++i) visit(near[i].index, near[i].distance2);
      }
    });
  }

  /// Calls `visit(first, last)` for ranges of places after `place` that hold all points after it
  /// within `radius_px` of it, px, and few others.
  template <typename Visit>
  void visit_runs_after(std::size_t place, double radius_px, Visit&& visit) const {
    const Vec2& x = placed_[place].location;
    const int here = row(x.y());
    const std::size_t end = first_[cell(column(x.x() + radius_px), here) + 1];
    if (place + 1 < end) visit(place + 1, end);
    visit_rows(here + 1, x, radius_px, visit);
  }

  /// px: radius that holds `count` points at the mean density of the cells round x. A search within
  /// it takes a time that does not depend on the density.
  double crowd_radius(const Vec2& x, double count) const {
    const int c0 = column(x.x() - cell_px_), c1 = column(x.x() + cell_px_);
    const int r0 = row(x.y() - cell_px_), r1 = row(x.y() + cell_px_);
    std::size_t there = 0;
    for (int r = r0; r <= r1; ++r) there += first_[cell(c1, r) + 1] - first_[cell(c0, r)];
    return 3 * cell_px_ * std::sqrt(count / (std::numbers::pi * static_cast<double>(there)));
  }

  /// Finds the `count` nearest points to x within `radius_px` that `accept(index)` accepts, in
  /// order.
  template <typename Accept>
  void nearest(const Vec2& x, double radius_px, std::size_t count, Accept&& accept,
               std::vector<Neighbour>& found) const {
    found.clear();
    make_room(found, size());
    visit_within(x, radius_px, [&](int index, double distance2) {
      if (accept(index)) found.push_back({distance2, index});
    });
    const auto end = found.begin() + static_cast<std::ptrdiff_t>(std::min(count, found.size()));
    std::partial_sort(found.begin(), end, found.end());
    found.erase(end, found.end());
  }

 private:
  struct Placed {
    Vec2 location;
    int index;
  };

  static constexpr double kMaxSide = 512;

  int column(double x) const { return clamped((x - low_.x()) / cell_px_, columns_); }
  int row(double y) const { return clamped((y - low_.y()) / cell_px_, rows_); }
  static int clamped(double cells, int count) {
    return static_cast<int>(std::clamp(cells, 0.0, static_cast<double>(count - 1)));
  }

  /// Visits the square about x, from a row of cells on. To cut its corners off would take longer.
  template <typename Visit>
  void visit_rows(int first_row, const Vec2& x, double radius_px, Visit&& visit) const {
    const int left = column(x.x() - radius_px), right = column(x.x() + radius_px);
    const int bottom = row(x.y() + radius_px);
    for (int r = first_row; r <= bottom; ++r) {
      const std::size_t first = first_[cell(left, r)], last = first_[cell(right, r) + 1];
      if (first < last) visit(first, last);
    }
  }

  std::size_t cell(int c, int r) const {
    return static_cast<std::size_t>(r) * static_cast<std::size_t>(columns_) +
           static_cast<std::size_t>(c);
  }

  std::vector<Placed> placed_;            // sorted by cell, then by index
  std::vector<float> x_px_, y_px_;        // of these
  std::vector<std::size_t> first_{0, 0};  // start of each cell in placed_, and the end
  std::vector<std::size_t> cell_of_;
  Vec2 low_ = Vec2::Zero();
  double cell_px_ = 1;
  int columns_ = 1, rows_ = 1;
};

}  // namespace lcs
