/// \file
/// Pairs that compete, as two groups that may be merged, or an edge and a corner.
#pragma once

#include <tuple>

namespace lcs {

/// Two things, by their indices, and what it costs to bring them together. Cheapest first, and of
/// equal ones by a and b: written by hand, as the comparisons of std::pair and std::tuple compare
/// doubles twice.
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
