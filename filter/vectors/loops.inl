// The loops of vectors.h. Included by a file for each set of instructions, inside of its namespace.
// Uses no inline function of a header, which would be compiled for one set and linked for all.

using Floats = float __attribute__((vector_size(4 * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));

namespace {

inline __attribute__((always_inline)) Floats load(const float* from) {
  Floats values;
  __builtin_memcpy(&values, from, sizeof values);
  return values;
}

inline __attribute__((always_inline)) void store(const Floats& values, float* to) {
  __builtin_memcpy(to, &values, sizeof values);
}

#ifdef __AVX2__
/// For each set of lanes: the lanes of the set, in order.
struct Orders {
  unsigned char of[256][8];
  constexpr Orders() : of() {
    for (int set = 0; set < 256; ++set) {
      int count = 0;
      for (int lane = 0; lane < 8; ++lane) {
        if ((set >> lane) & 1) of[set][count++] = static_cast<unsigned char>(lane);
      }
    }
  }
};
constexpr Orders kOrders;
#endif

/// Appends the values of the lanes that are kept, and their places.
inline __attribute__((always_inline)) std::size_t append(const Ints& kept, const Floats& values,
                                                         std::size_t first, int* places,
                                                         float* to) {
#ifdef __AVX2__
  const auto set = static_cast<unsigned>(_mm256_movemask_ps((__m256)kept));
  const __m256i order = _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i*)kOrders.of[set]));
  _mm256_storeu_ps(to, _mm256_permutevar8x32_ps((__m256)values, order));
  _mm256_storeu_si256((__m256i*)places,
                      _mm256_add_epi32(order, _mm256_set1_epi32(static_cast<int>(first))));
  return static_cast<std::size_t>(__builtin_popcount(set));
#else
  std::size_t count = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) {
    places[count] = static_cast<int>(first + lane);
    to[count] = values[lane];
    count += kept[lane] != 0;
  }
  return count;
#endif
}

constexpr Ints kLane = {0, 1, 2, 3, 4, 5, 6, 7};

/// The lanes that lie before the end of a range.
inline __attribute__((always_inline)) Ints before(std::size_t first, std::size_t last) {
  return kLane < static_cast<std::int32_t>(last - first);
}

/// e^x, with a relative error below 2e-7, for -87 < x < 88; at the bounds beyond them.
inline __attribute__((always_inline)) Floats exp_of(const Floats& argument) {
  Floats x = argument < -87.0F ? Floats{} - 87.0F : argument;
  x = x > 88.0F ? Floats{} + 88.0F : x;
  // 1.5 * 2^23 is added to round to an integer.
  const Floats n = (x * 1.44269504F + 12582912.0F) - 12582912.0F;
  const Floats r = (x - n * 0.693359375F) + n * 2.12194440e-4F;  // |r| <= ln 2 / 2
  // The polynomial of Cephes' expf (S. Moshier).
  Floats p = 1.9875691500e-4F * r + 1.3981999507e-3F;
  p = p * r + 8.3334519073e-3F;
  p = p * r + 4.1665795894e-2F;
  p = p * r + 1.6666665459e-1F;
  p = p * r + 5.0000001201e-1F;
  p = p * r * r + r + 1.0F;
  const Ints power = (__builtin_convertvector(n, Ints) + 127) << 23;
  return p * (Floats)power;
}

std::size_t within(const float* x_px, const float* y_px, std::size_t first, std::size_t last,
                   float x0_px, float y0_px, float radius2_px2, int* found, float* distance2_px2) {
  std::size_t count = 0;
  for (; first < last; first += kLanes) {
    const Floats x = load(x_px + first) - x0_px, y = load(y_px + first) - y0_px;
    const Floats apart2 = x * x + y * y;
    const Ints kept = (apart2 <= radius2_px2) & before(first, last);
    count += append(kept, apart2, first, found + count, distance2_px2 + count);
  }
  return count;
}

std::size_t count_within(const float* x_px, const float* y_px, std::size_t first, std::size_t last,
                         float x0_px, float y0_px, float radius2_px2) {
  Ints counts = {};
  for (; first < last; first += kLanes) {
    const Floats x = load(x_px + first) - x0_px, y = load(y_px + first) - y0_px;
    counts -= (x * x + y * y <= radius2_px2) & before(first, last);
  }
  int count = 0;
  for (std::size_t lane = 0; lane < kLanes; ++lane) count += counts[lane];
  return static_cast<std::size_t>(count);
}

std::size_t ties(const TieColumns& nodes, std::size_t node, float noise2_px2, std::size_t first,
                 std::size_t last, int* found, float* exponents) {
  const float x = nodes.x_px[node], y = nodes.y_px[node];
  const float step_x = nodes.step_x_px[node], step_y = nodes.step_y_px[node];
  const float reach2 = nodes.reach2_px2[node], length2 = nodes.length2_px2[node];
  const float variance = nodes.variance_px2[node] + noise2_px2;
  std::size_t count = 0;
  for (; first < last; first += kLanes) {
    const Floats off_x = load(nodes.x_px + first) - x, off_y = load(nodes.y_px + first) - y;
    const Floats turn_x = load(nodes.step_x_px + first) - step_x;
    const Floats turn_y = load(nodes.step_y_px + first) - step_y;
    const Floats reaches2 = load(nodes.reach2_px2 + first);
    const Floats lengths2 = load(nodes.length2_px2 + first);
    const Floats apart2 = off_x * off_x + off_y * off_y;
    const Floats exponent =
        apart2 / (reaches2 + reach2) + (turn_x * turn_x + turn_y * turn_y) /
                                           (load(nodes.variance_px2 + first) + variance +
                                            (lengths2 > length2 ? lengths2 : Floats{} + length2));
    const Ints kept = (apart2 <= nodes.far2 * (reaches2 < reach2 ? reaches2 : Floats{} + reach2)) &
                      (exponent < nodes.far2) & before(first, last);
    count += append(kept, exponent, first, found + count, exponents + count);
  }
  return count;
}

void exponentials(float* values, std::size_t count, float factor) {
  for (std::size_t i = 0; i < count; i += kLanes) {
    store(exp_of(factor * load(values + i)), values + i);
  }
}

void half_tanh(const float* m, float* result, std::size_t count) {
  for (std::size_t i = 0; i < count; i += kLanes) {
    store(1.0F - 2.0F / (1.0F + exp_of(load(m + i))), result + i);
  }
}

std::size_t alike(const Signature& one, const Signature* many, std::size_t count, int most_bits,
                  Alike* found) {
  const auto* a = reinterpret_cast<const std::uint64_t*>(&one);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const auto* b = reinterpret_cast<const std::uint64_t*>(many + i);
    const int bits = __builtin_popcountll(a[0] ^ b[0]) + __builtin_popcountll(a[1] ^ b[1]) +
                     __builtin_popcountll(a[2] ^ b[2]) + __builtin_popcountll(a[3] ^ b[3]);
    found[kept] = {static_cast<int>(i), bits};
    kept += bits <= most_bits;
  }
  return kept;
}

constexpr Loops kLoops = {within, count_within, ties, exponentials, half_tanh, alike};

}  // namespace
