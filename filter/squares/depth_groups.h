/// \file
/// Groups of things of one depth, from pairs that may belong together: best pair first (Kruskal),
/// and only while the means of the two groups agree, so that a chain of small steps does not join
/// near to far. Depths are in any unit that grows with 1/Z.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <vector>

#include "filter/matching/couples.h"
#include "filter/matching/disjoint_sets.h"
#include "filter/matching/point_grid.h"
#include "filter/matching/refill.h"

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

  /// Notes who may belong together: any two things near each other that cost less than 1.
  /// \param grid where the things are.
  /// \param reach_px(i) how far to look; less where things lie close, which then have links enough:
  /// \param crowd things, like and unlike, are looked at round each, about.
  /// \param cost(i, j, squared distance), symmetric: the cheaper, the sooner.
  template <typename Reach, typename Cost>
  void link_near(const PointGrid& grid, double crowd, Reach&& reach_px, Cost&& cost) {
    // Each pair is looked at once.
    const auto most = static_cast<std::size_t>(crowd / 2 * static_cast<double>(sets_.size()));
    if (links_.capacity() < most) links_.reserve(most + most / 4);
    grid.visit_crowd_pairs(crowd, reach_px, [&](int i, int j, double distance2) {
      const double c = cost(i, j, distance2);
      if (c < 1) links_.emplace_back(c, std::min(i, j), std::max(i, j));
    });
  }

  /// Merges along all links.
  template <typename Tolerance>
  void merge_links(Tolerance&& tolerance) {
    order_.visit(
        links_, [&](const Couple& link) { return sets_.are_joined(link.a, link.b); },
        [&](const Couple& link) { merge(link.a, link.b, tolerance); });
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

 private:
  DisjointSets sets_;
  std::vector<double> weight_, mean_;  // of the group that a root stands for
  std::vector<Couple> links_;
  CheapestFirst order_;
};

}  // namespace lcs
