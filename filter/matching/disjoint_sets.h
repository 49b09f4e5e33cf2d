/// \file
/// Union-find: connected components of n items, given connected pairs.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
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

  std::size_t size() const { return parent_.size(); }

 private:
  std::vector<int> parent_;
};

/// The members of disjoint sets; reuses its memory in each frame.
class SetMembers {
 public:
  void collect(DisjointSets& sets) {
    refill(first_, sets.size() + 2);
    for (std::size_t i = 0; i < sets.size(); ++i) ++first_[sets.root(static_cast<int>(i)) + 2];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    refill(members_, first_.back());
    for (std::size_t i = 0; i < sets.size(); ++i) {
      members_[first_[sets.root(static_cast<int>(i)) + 1]++] = static_cast<int>(i);
    }
  }

  /// Calls `visit(members)` for each set, by rising root; members rise.
  template <typename Visit>
  void visit(Visit&& visit) {
    for (std::size_t root = 0; root + 2 < first_.size(); ++root) {
      const std::span<int> members(members_.data() + first_[root], first_[root + 1] - first_[root]);
      if (!members.empty()) visit(members);
    }
  }

 private:
  std::vector<std::size_t> first_;  // start of each root's members in members_, and the end
  std::vector<int> members_;
};

}  // namespace lcs
