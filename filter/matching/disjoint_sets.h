/// \file
/// Union-find: connected components of n items, given connected pairs.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

#include "filter/vectors/refill.h"

namespace lcs {

class DisjointSets {
 public:
  /// n sets of one item each.
  void reset(std::size_t n) {
    refill(parent_, n);
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// The representative of an item's set.
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  bool are_together(int i, int j) { return parent_[i] == parent_[j] || root(i) == root(j); }

  /// Merges both sets; the root of `into` remains the root.
  void join(int into, int other) { parent_[root(other)] = root(into); }

  /// The representative of each item's set.
  const std::vector<int>& roots() {
    for (int& parent : parent_) parent = root(parent);
    return parent_;
  }

 private:
  std::vector<int> parent_;
};

}  // namespace lcs
