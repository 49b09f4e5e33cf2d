// Lanes of numbers, and functions of them. Included by a file for each set of instructions, inside
// of its namespace, before the loops that use them. Uses no inline function of a header, which
// would be compiled for one set and linked for all.

// Of each function that takes lanes: there is no common convention for passing them.
#define LCS_INLINE inline __attribute__((always_inline))

using Floats = float __attribute__((vector_size(4 * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));

namespace {

template <class Number>
LCS_INLINE auto load(const Number* from) {
  Number __attribute__((vector_size(4 * kLanes))) values;
  __builtin_memcpy(&values, from, sizeof values);
  return values;
}

LCS_INLINE void store(const Floats& values, float* to) {
  __builtin_memcpy(to, &values, sizeof values);
}

constexpr Ints kLane = {0, 1, 2, 3, 4, 5, 6, 7};

/// Whether any lane is set.
LCS_INLINE bool any(const Ints& lanes) {
#ifdef __AVX2__
  return _mm256_movemask_ps((__m256)lanes) != 0;
#else
  bool found = false;
  for (std::size_t lane = 0; lane < kLanes; ++lane) found |= lanes[lane] != 0;
  return found;
#endif
}

/// The sum of the lanes, in an order that is the same on any machine.
template <class Lanes>
LCS_INLINE auto total(const Lanes& lanes) {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) +
         ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

/// The lanes that lie before the end of a range.
LCS_INLINE Ints before(std::size_t first, std::size_t last) {
  return kLane < static_cast<std::int32_t>(last - first);
}

LCS_INLINE Floats larger(const Floats& a, const Floats& b) {
#ifdef __AVX2__
  return (Floats)_mm256_max_ps((__m256)a, (__m256)b);
#else
  return a > b ? a : b;
#endif
}

/// e^x, with a relative error below 2e-7, for -87 < x < 88; at the bounds beyond them.
LCS_INLINE Floats exp_of(const Floats& argument) {
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

/// ln(1 + t) for 0 <= t <= 1, by s = t / (2 + t) <= 1/3: 2 (s + s^3/3 + s^5/5 + ...).
LCS_INLINE Floats log1p_of(const Floats& t) {
  const Floats s = t / (2.0F + t), s2 = s * s;
  Floats sum = s2 * (1.0F / 15) + 1.0F / 13;
  sum = sum * s2 + 1.0F / 11;
  sum = sum * s2 + 1.0F / 9;
  sum = sum * s2 + 1.0F / 7;
  sum = sum * s2 + 1.0F / 5;
  sum = sum * s2 + 1.0F / 3;
  sum = sum * s2 + 1.0F;
  return 2.0F * s * sum;
}

/// ln x of normal numbers above 0.
LCS_INLINE Floats log_of(const Floats& x) {
  const Floats exponent = __builtin_convertvector(((Ints)x >> 23) - 127, Floats);
  const Floats mantissa = (Floats)(((Ints)x & 0x7fffff) | 0x3f800000);  // in [1, 2)
  return exponent * 0.6931471805599453F + log1p_of(mantissa - 1.0F);
}

/// ln(1 + e^x), with an error below 2e-7 times itself and 1e-7.
LCS_INLINE Floats softplus(const Floats& x) {
  return (x > 0.0F ? x : Floats{}) + log1p_of(exp_of(x < 0.0F ? x : -x));
}

/// The numbers of a column that lie at some indices.
LCS_INLINE Floats gather(const float* from, const Ints& indices) {
#ifdef __AVX2__
  return (Floats)_mm256_i32gather_ps(from, (__m256i)indices, 4);
#else
  Floats values;
  for (std::size_t lane = 0; lane < kLanes; ++lane) values[lane] = from[indices[lane]];
  return values;
#endif
}
LCS_INLINE Ints gather(const int* from, const Ints& indices) {
  Ints values;
  for (std::size_t lane = 0; lane < kLanes; ++lane) values[lane] = from[indices[lane]];
  return values;
}

}  // namespace
