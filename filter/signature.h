/// \file
/// What a corner looks like, in 256 bits, of which few differ between two pictures of one place:
/// so that corners can be told apart by more than where they are, and no picture is kept.
#pragma once

#include <array>
#include <bit>
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
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits += std::popcount(a[i] ^ b[i]);
  return bits;
}

}  // namespace lcs
