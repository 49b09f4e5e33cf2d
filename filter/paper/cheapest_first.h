/// \file
/// Visits couples in order of cost, where accepting one usually rules out many others.
#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <span>
#include <vector>

#include "filter/matching/couples.h"
#include "filter/vectors/refill.h"

namespace lcs::paper {

/// Visits couples, cheapest first.
class CheapestFirst {
 public:
  /// Calls `settle(couple)` for each in order, except those for which `is_settled(couple)` is true.
  /// Filters and sorts one cost range at a time, so that most couples are never sorted. Costs must
  /// be finite.
  template <typename IsSettled, typename Settle>
  void visit(std::span<const Couple> couples, IsSettled&& is_settled, Settle&& settle) {
    portion(couples);
    std::size_t first = 0;
    for (const std::size_t last : ends_) {
      const auto begin = portions_.begin() + static_cast<std::ptrdiff_t>(first);
      const auto end = std::remove_if(begin, portions_.begin() + static_cast<std::ptrdiff_t>(last),
                                      [&](std::uint32_t i) { return is_settled(couples[i]); });
      std::sort(begin, end,
                [&](std::uint32_t i, std::uint32_t j) { return couples[i] < couples[j]; });
      for (auto i = begin; i != end; ++i) {
        if (!is_settled(couples[*i])) settle(couples[*i]);
      }
      first = last;
    }
  }

 private:
  /// Counting sort into cost ranges of equal width, as many as there are couples.
  void portion(std::span<const Couple> couples) {
    refill(portions_, couples.size());
    refill(ends_, 1 + couples.size());
    if (couples.empty()) return;
    float low = couples.front().cost, high = low;
    for (const Couple& couple : couples) {
      low = std::min(low, couple.cost);
      high = std::max(high, couple.cost);
    }
    const double last = static_cast<double>(ends_.size() - 1);
    const double per_cost = high > low ? last / (double{high} - low) : 0;
    const auto portion_of = [&](const Couple& couple) {
      return static_cast<std::size_t>((double{couple.cost} - low) * per_cost);
    };
    for (const Couple& couple : couples) ++ends_[portion_of(couple)];
    // First the start of each range; placing the couples advances it to the end.
    std::exclusive_scan(ends_.begin(), ends_.end(), ends_.begin(), std::uint32_t{0});
    std::uint32_t index = 0;
    for (const Couple& couple : couples) portions_[ends_[portion_of(couple)]++] = index++;
  }

  std::vector<std::uint32_t> portions_;  // indices of couples
  std::vector<std::uint32_t> ends_;      // of each cost range
};

}  // namespace lcs::paper
