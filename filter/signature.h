/// \file
/// A corner's descriptor: 256 bits, few of which differ between two pictures of the same place. It
/// tells corners apart by their looks, without a picture being kept.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

namespace lcs {

/// What the bits mean is up to who makes them (`filter/detect/describe.h`); the filter only counts
/// how many differ.
using Signature = std::array<std::uint64_t, 4>;
/// The same bits as bytes: std::bit_cast takes one to the other, to make and to store them.
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
