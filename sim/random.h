/// \file
/// Random numbers with the same bits on every machine, in independent streams.
///
/// A stream is named: it depends on the scenario's seed and its own name alone, so that a sensor
/// added to a run leaves the numbers of all others as they were. The generator is Philox4x32-10
/// (Salmon et al., "Parallel random numbers: as easy as 1, 2, 3", SC 2011), which encrypts a
/// counter. Everything beyond it is IEEE arithmetic in a fixed order (sqrt and frexp are exact by
/// standard): no std:: distribution, and no logarithm of the C library, whose last bit differs
/// between versions and CPUs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lcs::sim {

/// One block of Philox4x32-10.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// A sequence of random numbers: a new one with the same seed and name gives the same numbers.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  std::uint64_t bits();  ///< 64 random bits
  double uniform();      ///< in [0, 1), a multiple of 2^-53
  double normal();       ///< mean 0, variance 1

 private:
  std::array<std::uint32_t, 2> key_;
  std::uint64_t block_ = 0;
  std::optional<std::uint64_t> second_half_;  ///< of the last block
  std::optional<double> second_normal_;       ///< of the last pair
};

}  // namespace lcs::sim
