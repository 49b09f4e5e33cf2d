/// \file
/// Groups of things of one depth, from pairs that may belong together: best pair first (Kruskal),
/// and only while the means of the two groups agree, so that a chain of small steps does not join
/// near to far. Depths are in any unit that grows with 1/Z.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <span>
#include <tuple>
#include <vector>

#include "filter/disjoint_sets.h"
#include "filter/point_grid.h"
#include "filter/refill.h"

namespace lcs {

class DepthGroups {
 public:
  /// n groups of one thing each, without links.
  void reset(std::size_t n) {
    sets_.reset(n);
    refill(weight_, n);
    refill(mean_, n);
    links_.clear();
  }

  /// \param sigma its standard deviation, > 0.
  void set_depth(std::size_t i, double depth, double sigma) {
    mean_[i] = depth;
    weight_[i] = 1 / (sigma * sigma);
  }

  /// What may belong together: each thing and the `count` nearest of those that cost less than 1.
  /// \param points where the things are; \param grid of them.
  /// \param reach_px(i) how far to look; \param cost(i, j), symmetric: the cheaper, the sooner.
  template <typename Reach, typename Cost>
  void link_nearest(std::span<const Vec2> points, const PointGrid& grid, std::size_t count,
                    Reach&& reach_px, Cost&& cost) {
    refill(costs_, points.size());
    refill(ends_, points.size() + 1);
    neighbours_.clear();
    for (std::size_t i = 0; i < points.size(); ++i) {
      const int a = static_cast<int>(i);
      const auto is_cheap = [&](int b) { return b != a && (costs_[b] = cost(a, b)) < 1; };
      grid.nearest(points[i], reach_px(a), count, is_cheap, near_);
      for (const auto& [distance2, b] : near_) {
        neighbours_.push_back(b);
        if (b > a || !is_neighbour(b, a)) links_.push_back({costs_[b], a, b});
      }
      ends_[i + 1] = neighbours_.size();
    }
  }

  /// Merges along all links.
  template <typename Tolerance>
  void merge_links(Tolerance&& tolerance) {
    std::sort(links_.begin(), links_.end());
    for (const Link& link : links_) merge(link.a, link.b, tolerance);
  }

  /// Makes one group of those of a and b, unless their means differ by `tolerance(depth)` and twice
  /// their errors.
  template <typename Tolerance>
  void merge(int a, int b, Tolerance&& tolerance) {
    a = sets_.root(a);
    b = sets_.root(b);
    if (a == b) return;
    const double most =
        tolerance(0.5 * (mean_[a] + mean_[b])) + 2 * std::sqrt(1 / weight_[a] + 1 / weight_[b]);
    if (!(std::abs(mean_[a] - mean_[b]) < most)) return;
    sets_.join(a, b);
    mean_[a] = (weight_[a] * mean_[a] + weight_[b] * mean_[b]) / (weight_[a] + weight_[b]);
    weight_[a] += weight_[b];
  }

  DisjointSets& sets() { return sets_; }
  /// Of the group that this root stands for.
  double mean(int root) const { return mean_[root]; }

 private:
  struct Link {
    double cost;
    int a, b;
    /// Cheapest first, and of equal ones by what they join.
    bool operator<(const Link& other) const {
      return cost < other.cost ||
             (cost == other.cost && std::tuple(a, b) < std::tuple(other.a, other.b));
    }
  };

  /// Whether b was among the nearest of a.
  bool is_neighbour(int a, int b) const {
    const auto first = neighbours_.begin();
    const auto end = first + static_cast<std::ptrdiff_t>(ends_[a + 1]);
    return std::find(first + static_cast<std::ptrdiff_t>(ends_[a]), end, b) != end;
  }

  DisjointSets sets_;
  std::vector<double> weight_, mean_;  // of the group that a root stands for
  std::vector<Link> links_;
  std::vector<double> costs_;      // of what was asked about last
  std::vector<int> neighbours_;    // of each thing in turn
  std::vector<std::size_t> ends_;  // of each thing's in neighbours_, after a 0
  std::vector<Neighbour> near_;
};

}  // namespace lcs
