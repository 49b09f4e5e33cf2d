#include "sim/base/random.h"

#include <cmath>
#include <numbers>

namespace lcs::sim {
namespace {

/// Finalizer of splitmix64: each bit of the input affects about half the bits of the output.
std::uint64_t mix(std::uint64_t x) {
  x = (x ^ (x >> 30)) * 0xBF58476D1CE4E5B9u;
  x = (x ^ (x >> 27)) * 0x94D049BB133111EBu;
  return x ^ (x >> 31);
}

/// FNV-1a.
std::uint64_t hash(std::string_view text) {
  std::uint64_t h = 0xCBF29CE484222325u;
  for (const char c : text) h = (h ^ static_cast<std::uint8_t>(c)) * 0x100000001B3u;
  return h;
}

std::uint32_t low(std::uint64_t x) {
  return static_cast<std::uint32_t>(x);
}
std::uint32_t high(std::uint64_t x) {
  return static_cast<std::uint32_t>(x >> 32);
}

/// Natural logarithm of x > 0, to about 1e-16: x = m 2^e with m in [sqrt(1/2), sqrt(2)), and
/// log m = 2 atanh(t) with t = (m - 1) / (m + 1), |t| < 0.172, summed from its series.
double portable_log(double x) {
  int exponent = 0;
  double m = std::frexp(x, &exponent);
  if (m < std::numbers::sqrt2 / 2) {
    m *= 2;
    --exponent;
  }
  const double t = (m - 1) / (m + 1);
  const double t2 = t * t;
  double sum = 0;
  for (int k = 21; k >= 1; k -= 2) sum = sum * t2 + 1.0 / k;
  return 2 * t * sum + exponent * std::numbers::ln2;
}

}  // namespace

std::array<std::uint32_t, 4> philox4x32(std::array<std::uint32_t, 4> counter,
                                        std::array<std::uint32_t, 2> key) {
  for (int round = 0; round < 10; ++round) {
    const std::uint64_t a = std::uint64_t{0xD2511F53} * counter[0];
    const std::uint64_t b = std::uint64_t{0xCD9E8D57} * counter[2];
    counter = {high(b) ^ counter[1] ^ key[0], low(b), high(a) ^ counter[3] ^ key[1], low(a)};
    key[0] += 0x9E3779B9;
    key[1] += 0xBB67AE85;
  }
  return counter;
}

RandomStream::RandomStream(std::uint64_t seed, std::string_view name) {
  const std::uint64_t key = mix(mix(seed + 0x9E3779B97F4A7C15u) ^ hash(name));
  key_ = {low(key), high(key)};
}

std::uint64_t RandomStream::bits() {
  if (second_half_) {
    const std::uint64_t half = *second_half_;
    second_half_.reset();
    return half;
  }
  const auto block = philox4x32({low(block_), high(block_), 0, 0}, key_);
  ++block_;
  second_half_ = std::uint64_t{block[3]} << 32 | block[2];
  return std::uint64_t{block[1]} << 32 | block[0];
}

double RandomStream::uniform() {
  return static_cast<double>(bits() >> 11) * 0x1p-53;
}

double RandomStream::exponential() {
  return -portable_log(1 - uniform());
}

/// A pair of normals by Marsaglia's polar method, which needs no sine.
double RandomStream::normal() {
  if (second_normal_) {
    const double normal = *second_normal_;
    second_normal_.reset();
    return normal;
  }
  for (;;) {
    const double x = 2 * uniform() - 1;
    const double y = 2 * uniform() - 1;
    const double s = x * x + y * y;
    if (s >= 1 || s == 0) continue;
    const double scale = std::sqrt(-2 * portable_log(s) / s);
    second_normal_ = y * scale;
    return x * scale;
  }
}

}  // namespace lcs::sim
