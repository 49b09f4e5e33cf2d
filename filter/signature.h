/// \file
/// What a corner looks like, in 256 bits, of which few differ between two pictures of one place:
/// so that corners can be told apart by more than where they are, and no picture is kept.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lcs {

/// Who made them knows what the bits mean (`filter/detect/describe.h`); to the filter it is their
/// number that differs.
using Signature = std::array<std::uint64_t, 4>;
/// The same in memory, to make and to store them by std::bit_cast.
using SignatureBytes = std::array<std::uint8_t, sizeof(Signature)>;

/// How many bits differ: 0 to 256.
inline int distance(const Signature& a, const Signature& b) {
  // All words at once, in bytes: on the x86-64 baseline std::popcount is a call for each.
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    std::uint64_t x = a[i] ^ b[i];
    x -= (x >> 1) & 0x5555555555555555;
    x = (x & 0x3333333333333333) + ((x >> 2) & 0x3333333333333333);
    sum += (x + (x >> 4)) & 0x0f0f0f0f0f0f0f0f;
  }
  sum = (sum & 0x00ff00ff00ff00ff) + ((sum >> 8) & 0x00ff00ff00ff00ff);
  return static_cast<int>((sum * 0x0001000100010001) >> 48);
}

}  // namespace lcs
