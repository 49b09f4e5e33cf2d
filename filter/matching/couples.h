/// \file
/// Candidate pairs: two groups that may merge, or an edge and a corner.
#pragma once

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <numeric>
#include <tuple>
#include <vector>

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

/// Sorts couples whose costs are not negative, as std::sort would. By counting two digits of the
/// costs (their first 22 bits), because a comparison of costs at random is mispredicted half of the
/// time. Couples that share these bits are few, and compared.
/// \param room scratch storage.
inline void sort_couples(std::vector<Couple>& couples, std::vector<Couple>& room) {
  room.assign(couples.begin(), couples.end());
  const auto bits = [](const Couple& couple) { return std::bit_cast<std::uint32_t>(couple.cost); };
  for (int shift = 10; shift < 32; shift += 11) {
    // The bits of floats that are not negative have the floats' order.
    const auto digit = [&](const Couple& couple) { return (bits(couple) >> shift) % 2048; };
    std::array<std::uint32_t, 2049> first{};  // start of each digit's couples
    for (const Couple& couple : couples) ++first[digit(couple) + 1];
    std::partial_sum(first.begin(), first.end(), first.begin());
    for (const Couple& couple : couples) room[first[digit(couple)]++] = couple;
    couples.swap(room);
  }
  for (auto run = couples.begin(); run != couples.end();) {
    const std::uint32_t first_bits = bits(*run) >> 10;
    const auto end =
        std::find_if(run, couples.end(), [&](auto& c) { return bits(c) >> 10 != first_bits; });
    if (end - run > 1) std::sort(run, end);
    run = end;
  }
}

}  // namespace lcs
