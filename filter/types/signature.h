/// \file
/// A corner's descriptor: 256 bits, few of which differ between two pictures of one place. It
/// identifies corners by appearance without storing a picture.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>

namespace lcs {

/// The detector defines the bits (`filter/detect/describe.h`); the filter only counts differing
/// bits.
using Signature = std::array<std::uint64_t, 4>;
/// The same bits as bytes, by std::bit_cast, for computing and storing them.
using SignatureBytes = std::array<std::uint8_t, sizeof(Signature)>;

/// Hamming distance, 0 to 256.
inline int distance(const Signature& a, const Signature& b) {
  int bits = 0;
  for (std::size_t i = 0; i < a.size(); ++i) bits += std::popcount(a[i] ^ b[i]);
  return bits;
}

/// One of a list of signatures, and its distance.
struct Alike {
  int place, bits;
};

}  // namespace lcs
