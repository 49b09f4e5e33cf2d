/// \file
/// Union-find: which of n things are connected, by pairs that are.
#pragma once

#include <cstddef>
#include <numeric>
#include <vector>

namespace lcs {

class DisjointSets {
 public:
  /// n sets of one thing each.
  void reset(std::size_t n) {
    parent_.resize(n);
    std::iota(parent_.begin(), parent_.end(), 0);
  }

  /// The thing that stands for the set of this one.
  int root(int i) {
    while (parent_[i] != i) i = parent_[i] = parent_[parent_[i]];
    return i;
  }

  /// Both sets become one, whose root is that of `into`.
  void join(int into, int other) { parent_[root(other)] = root(into); }

 private:
  std::vector<int> parent_;
};

}  // namespace lcs
