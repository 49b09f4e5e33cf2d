/// \file
/// A corner's descriptor: 256 bits, few of which differ between two pictures of one place. It
/// identifies corners by appearance without storing a picture.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

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

/// Finds the signatures of a list that are at most `most_bits` from one, by the machine's own
/// instruction for it where it has one.
/// \param found room for as many as `many`.
/// \return how many were found.
std::size_t find_alike(const Signature& one, std::span<const Signature> many, int most_bits,
                       std::span<Alike> found);

}  // namespace lcs
