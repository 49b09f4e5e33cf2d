/// \file
/// Candidate pairs: two groups that may merge, or an edge and a corner.
#pragma once

#include <tuple>

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

}  // namespace lcs
