#include "filter/signature.h"

namespace lcs {
namespace {

#if defined(__x86_64__) && defined(__GNUC__)
[[gnu::target("popcnt")]] std::size_t find_by_popcnt(const Signature& one,
                                                     std::span<const Signature> many, int most_bits,
                                                     std::span<Alike> found) {
  std::size_t count = 0;
  for (std::size_t i = 0; i < many.size(); ++i) {
    int bits = 0;
    for (std::size_t k = 0; k < one.size(); ++k) bits += __builtin_popcountll(one[k] ^ many[i][k]);
    found[count] = {static_cast<int>(i), bits};
    count += bits <= most_bits;
  }
  return count;
}

const bool has_popcnt = __builtin_cpu_supports("popcnt");
#endif

}  // namespace

std::size_t find_alike(const Signature& one, std::span<const Signature> many, int most_bits,
                       std::span<Alike> found) {
#if defined(__x86_64__) && defined(__GNUC__)
  if (has_popcnt) return find_by_popcnt(one, many, most_bits, found);
#endif
  std::size_t count = 0;
  for (std::size_t i = 0; i < many.size(); ++i) {
    found[count] = {static_cast<int>(i), distance(one, many[i])};
    count += found[count].bits <= most_bits;
  }
  return count;
}

}  // namespace lcs
