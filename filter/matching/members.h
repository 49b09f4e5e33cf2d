/// \file
/// Items by their groups: edges by circle, or by the root of their set.
#pragma once

#include <cstddef>
#include <numeric>
#include <span>
#include <vector>

#include "filter/vectors/refill.h"

namespace lcs {

/// The members of each group; reuses its memory in each frame.
class Members {
 public:
  /// \param group_of each item's group, below `groups`; -1: none.
  void collect(std::span<const int> group_of, std::size_t groups) {
    // Counting sort; the items without a group come first.
    refill(first_, groups + 3);
    for (const int group : group_of) ++first_[group + 3];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    refill(members_, group_of.size());
    for (std::size_t i = 0; i < group_of.size(); ++i) {
      members_[first_[group_of[i] + 2]++] = static_cast<int>(i);
    }
  }

  /// Indices of the items of a group, rising.
  std::span<const int> of(std::size_t group) const {
    return {members_.data() + first_[group + 1], members_.data() + first_[group + 2]};
  }

 private:
  std::vector<std::size_t> first_;  // start of each group's items in members_, and the end
  std::vector<int> members_;
};

}  // namespace lcs
