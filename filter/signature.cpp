#include "filter/signature.h"

namespace lcs {
namespace {

/// Compiled into each of its callers, for the instructions that the caller may use.
[[gnu::always_inline]] inline std::size_t find(const Signature& one,
                                               std::span<const Signature> many, int most_bits,
                                               std::span<Alike> found) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < many.size(); ++i) {
    found[count] = {static_cast<int>(i), distance(one, many[i])};
    count += found[count].bits <= most_bits;
  }
  return count;
}

#if defined(__x86_64__)
[[gnu::target("popcnt")]] std::size_t find_by_popcnt(const Signature& one,
                                                     std::span<const Signature> many, int most_bits,
                                                     std::span<Alike> found) {
  return find(one, many, most_bits, found);
}

const bool has_popcnt = __builtin_cpu_supports("popcnt");
#endif

}  // namespace

std::size_t find_alike(const Signature& one, std::span<const Signature> many, int most_bits,
                       std::span<Alike> found) {
#if defined(__x86_64__)
  if (has_popcnt) return find_by_popcnt(one, many, most_bits, found);
#endif
  return find(one, many, most_bits, found);
}

}  // namespace lcs
