/// \file
/// Candidate pairs: two groups that may merge, or an edge and a corner.
#pragma once

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <vector>

#include "filter/vectors/refill.h"

namespace lcs {

/// Two indices and the cost of pairing them. Sorted by cost, then a, then b. Hand-written, as
/// comparisons of std::pair and std::tuple compare doubles twice.
struct Couple {
  Couple(double what_it_costs, int one, int other)
      : cost(static_cast<float>(what_it_costs)), a(one), b(other) {}
  float cost;
  int a, b;
  bool operator<(const Couple& other) const {
    return cost < other.cost ||
           (cost == other.cost && std::tuple(a, b) < std::tuple(other.a, other.b));
  }
};

/// Sorts couples, as std::sort would.
class CoupleSorter {
 public:
  void make_room(std::size_t couples) {
    lcs::make_room(first_, couples + 3);
    lcs::make_room(sorted_, couples);
  }

  /// \param most, least the costs lie between them.
  void sort(std::vector<Couple>& couples, float most, float least = 0) {
    // By counting as many even bins of costs as there are couples, because a comparison of costs at
    // random is mispredicted half of the time. The couples of a bin are few, and compared.
    const std::size_t count = couples.size();
    const float per_cost = most > least ? static_cast<float>(count) / (most - least) : 0;
    const auto bin = [&](const Couple& couple) {
      return std::min(static_cast<std::uint32_t>((couple.cost - least) * per_cost),
                      static_cast<std::uint32_t>(count));
    };
    refill(first_, count + 3);
    for (const Couple& couple : couples) ++first_[bin(couple) + 2];
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    copy_over(couples, sorted_);
    for (const Couple& couple : couples) sorted_[first_[bin(couple) + 1]++] = couple;
    couples.swap(sorted_);
    for (std::size_t b = 0; b <= count; ++b) {
      if (first_[b + 1] - first_[b] > 1) {
        std::sort(couples.begin() + first_[b], couples.begin() + first_[b + 1]);
      }
    }
  }

 private:
  std::vector<std::uint32_t> first_;  // couple of each bin, and the end
  std::vector<Couple> sorted_;
};

}  // namespace lcs
