/// \file
/// Groups of things of one depth, from pairs that may belong together: best pair first (Kruskal),
/// and only while the means of the two groups agree, so that a chain of small steps does not join
/// near to far. Depths are in any unit that grows with 1/Z.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>
#include <vector>

#include "filter/disjoint_sets.h"
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

  /// a and b may belong together; the cheaper the sooner.
  void link(double cost, int a, int b) { links_.push_back({cost, a, b}); }

  /// Merges along all links.
  template <typename Tolerance>
  void merge_links(Tolerance&& tolerance) {
    std::sort(links_.begin(), links_.end(), [](const Link& x, const Link& y) {
      return std::tuple(x.cost, x.a, x.b) < std::tuple(y.cost, y.a, y.b);
    });
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
  };

  DisjointSets sets_;
  std::vector<double> weight_, mean_;  // of the group that a root stands for
  std::vector<Link> links_;
};

}  // namespace lcs
