/// \file
/// Random numbers that are bitwise equal on every machine, in independent streams.
///
/// A stream depends on the scenario's seed and its own name alone, so that adding a sensor to a run
/// leaves the numbers of all others unchanged. The generator is Philox4x32-10 (Salmon et al.,
/// "Parallel random numbers: as easy as 1, 2, 3", SC 2011), which encrypts a counter. All else is
/// IEEE arithmetic in a fixed order (sqrt and frexp are exact by standard). It uses no std::
/// distribution and no log of the C library, whose last bit differs between versions and CPUs.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string_view>

namespace lcs::sim {

/// One block of Philox4x32-10.
std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key);

/// A sequence of random numbers. Equal seed and name give equal numbers.
class RandomStream {
 public:
  RandomStream(std::uint64_t seed, std::string_view name);

  std::uint64_t bits();  ///< 64 random bits
  double uniform();      ///< in [0, 1), a multiple of 2^-53
  double normal();       ///< mean 0, variance 1
  double exponential();  ///< mean 1

 private:
  std::array<std::uint32_t, 2> key_;
  std::uint64_t block_ = 0;
  std::optional<std::uint64_t> second_half_;  ///< of the last Philox block
  std::optional<double> second_normal_;       ///< of the last pair of normals
};

}  // namespace lcs::sim
