// The loops of vectors.h. Included by a file for each set of instructions, inside of its namespace.
// Uses no inline function of a header, which would be compiled for one set and linked for all.

using Floats = float __attribute__((vector_size(4 * kLanes)));
using Doubles = double __attribute__((vector_size(4 * kLanes)));
using Longs = std::int64_t __attribute__((vector_size(4 * kLanes)));
using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));

namespace {

template <class Number>
inline __attribute__((always_inline)) auto load(const Number* from) {
  Number __attribute__((vector_size(4 * kLanes))) values;
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

/// Whether any lane is set.
inline __attribute__((always_inline)) bool any(const Ints& lanes) {
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
inline __attribute__((always_inline)) auto total(const Lanes& lanes) {
  return ((lanes[0] + lanes[1]) + (lanes[2] + lanes[3])) +
         ((lanes[4] + lanes[5]) + (lanes[6] + lanes[7]));
}

/// The lanes that lie before the end of a range.
inline __attribute__((always_inline)) Ints before(std::size_t first, std::size_t last) {
  return kLane < static_cast<std::int32_t>(last - first);
}

inline __attribute__((always_inline)) Floats larger(const Floats& a, const Floats& b) {
#ifdef __AVX2__
  return (Floats)_mm256_max_ps((__m256)a, (__m256)b);
#else
  return a > b ? a : b;
#endif
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

inline __attribute__((always_inline)) Doubles root_of(const Doubles& x) {
#ifdef __AVX2__
  return (Doubles)_mm256_sqrt_pd((__m256d)x);
#else
  return Doubles{__builtin_sqrt(x[0]), __builtin_sqrt(x[1]), __builtin_sqrt(x[2]),
                 __builtin_sqrt(x[3])};
#endif
}

/// e^x, with a relative error below 2e-7, for -700 < x < 700; at the bounds beyond them.
inline __attribute__((always_inline)) Doubles exp_of(const Doubles& argument) {
  Doubles x = argument < -700.0 ? Doubles{} - 700.0 : argument;
  x = x > 700.0 ? Doubles{} + 700.0 : x;
  // 1.5 * 2^52 is added to round to an integer, whose bits are then the last ones.
  const Doubles shifted = x * 1.4426950408889634 + 6755399441055744.0;
  const Doubles n = shifted - 6755399441055744.0;
  const Doubles r = x - n * 0.6931471805599453;
  Doubles p = 1.9875691500e-4 * r + 1.3981999507e-3;
  p = p * r + 8.3334519073e-3;
  p = p * r + 4.1665795894e-2;
  p = p * r + 1.6666665459e-1;
  p = p * r + 5.0000001201e-1;
  p = p * r * r + r + 1.0;
  const Longs power = ((Longs)shifted + 1023) << 52;
  return p * (Doubles)power;
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

void ranks(const float* values, std::size_t count, int* places) {
  for (std::size_t first = 0; first < count; first += kLanes) {
    const Floats own = load(values + first);
    Ints lower = {};
    std::size_t k = 0;
#pragma GCC unroll 8
    for (; k < first; ++k) lower -= values[k] <= own;
#pragma GCC unroll 8
    for (std::int32_t lane = 0; lane < static_cast<std::int32_t>(kLanes); ++lane, ++k) {
      if (k == count) break;
      lower -= lane < kLane ? values[k] <= own : values[k] < own;
    }
#pragma GCC unroll 8
    for (; k < count; ++k) lower -= values[k] < own;
    __builtin_memcpy(places + first, &lower, sizeof lower);
  }
}

std::size_t ties(const TieColumns& nodes, std::size_t node, float noise2_px2, std::size_t first,
                 std::size_t last, std::uint32_t* starts, float* weights) {
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
    if (!any(kept)) continue;
    starts[count] = static_cast<std::uint32_t>(first);
    store(kept ? exp_of(-0.5F * exponent) : Floats{}, weights + kLanes * count++);
  }
  return count;
}

void tied_sums(const Ties& ties, const float* values, std::size_t count, float* sums) {
  for (std::size_t i = 0; i < count; i += kLanes) store(Floats{}, sums + i);
  for (std::size_t node = 0; node < count; ++node) {
    const float own = values[node];
    Floats sum = {};
    for (std::size_t block = ties.first[node]; block < ties.first[node + 1]; ++block) {
      const Floats weights = load(ties.weights + kLanes * block);
      const std::size_t start = ties.starts[block];
      sum += weights * load(values + start);
      store(load(sums + start) + weights * own, sums + start);
    }
    sums[node] += total(sum);
  }
}

std::size_t links(const LinkColumns& nodes, std::size_t node, float radius2_px2, std::size_t first,
                  std::size_t last, int* found, float* distances2) {
  const float x = nodes.x_px[node], y = nodes.y_px[node], reach2 = nodes.reach2_px2[node];
  const float value = nodes.value[node], variance = nodes.variance[node];
  std::size_t count = 0;
  for (; first < last; first += kLanes) {
    const Floats off_x = load(nodes.x_px + first) - x, off_y = load(nodes.y_px + first) - y;
    const Floats apart2 = off_x * off_x + off_y * off_y;
    const Floats unlike = load(nodes.value + first) - value;
    const Floats reaches2 = load(nodes.reach2_px2 + first);
    const Floats distance2 = apart2 / (reaches2 < reach2 ? reaches2 : Floats{} + reach2);
    const Ints kept = (apart2 <= radius2_px2) & (distance2 < nodes.far2) &
                      (unlike * unlike < nodes.far2 * (load(nodes.variance + first) + variance)) &
                      before(first, last);
    count += append(kept, distance2, first, found + count, distances2 + count);
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

/// ln(1 + t) for 0 <= t <= 1, by s = t / (2 + t) <= 1/3: 2 (s + s^3/3 + s^5/5 + ...).
inline __attribute__((always_inline)) Floats log1p_of(const Floats& t) {
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
inline __attribute__((always_inline)) Floats log_of(const Floats& x) {
  const Floats exponent = __builtin_convertvector(((Ints)x >> 23) - 127, Floats);
  const Floats mantissa = (Floats)(((Ints)x & 0x7fffff) | 0x3f800000);  // in [1, 2)
  return exponent * 0.6931471805599453F + log1p_of(mantissa - 1.0F);
}

/// ln(1 + e^x), with an error below 2e-7 times itself and 1e-7.
inline __attribute__((always_inline)) Floats softplus(const Floats& x) {
  return (x > 0.0F ? x : Floats{}) + log1p_of(exp_of(x < 0.0F ? x : -x));
}

void votes(const PairColumns& pairs, const int* neighbours, const float* weights,
           const float* ln_clutter, std::size_t count, std::size_t asked, float* sums) {
  const Floats step_x = load(pairs.step_x_px + asked), step_y = load(pairs.step_y_px + asked);
  const Floats variance = pairs.variance_px2 + pairs.share2 * (step_x * step_x + step_y * step_y);
  const Floats per_px2 = -0.5F / variance, ln_spread = log_of(6.283185307179586F * variance);
  Floats votes[kLanes] = {};  // several sums, so that an addition need not wait for the last
  for (std::size_t voice = 0; voice < count; ++voice) {
    const std::size_t first = static_cast<std::size_t>(neighbours[voice]) * pairs.places;
    const std::size_t end = first + pairs.counts[neighbours[voice]];
    Floats agrees = Floats{} - 1e30F;  // ln V, before what is common to all pairs of a corner
    for (std::size_t p = first; p < end; ++p) {
      const Floats x = pairs.step_x_px[p] - step_x, y = pairs.step_y_px[p] - step_y;
      agrees = larger(agrees, per_px2 * (x * x + y * y) + pairs.likeness[p]);
    }
    votes[voice % kLanes] +=
        weights[voice] * (softplus(agrees - ln_spread - ln_clutter[voice]) - 0.6931471805599453F);
  }
  store(total(votes), sums);
}

void normal_sums(const ResidualColumns& residuals, std::size_t count, const double* fix,
                 const double* root, NormalSums& sums) {
  Doubles information[21] = {}, pull[6] = {};
  for (std::size_t k = 0; k < count; k += 4) {
    const Doubles hx = load(residuals.h_x + k), hy = load(residuals.h_y + k);
    const Doubles motion = load(residuals.motion_s + k) * residuals.focal_px;
    const double f = residuals.focal_px;
    const Doubles J[2][6] = {
        {f * hx * hy, -f * (1.0 + hx * hx), f * hy, -motion, Doubles{}, motion * hx},
        {f * (1.0 + hy * hy), -f * hx * hy, -f * hx, Doubles{}, -motion, motion * hy}};
    const Doubles off[2] = {load(residuals.off_x_px + k), load(residuals.off_y_px + k)};
    Doubles left[2] = {off[0], off[1]};
    // Covariance S of the residual; T adds the covariance of the fix, J root (J root)^T.
    const Doubles S_xx = load(residuals.S_xx_px2 + k), S_xy = load(residuals.S_xy_px2 + k);
    const Doubles S_yy = load(residuals.S_yy_px2 + k);
    Doubles T_xx = S_xx, T_xy = S_xy, T_yy = S_yy;
    for (int column = 0; column < 6; ++column) {
      Doubles spread[2] = {};
      for (int row = column; row < 6; ++row) {
        const double entry = root[row * (row + 1) / 2 + column];
        spread[0] += J[0][row] * entry;
        spread[1] += J[1][row] * entry;
      }
      T_xx += spread[0] * spread[0];
      T_xy += spread[0] * spread[1];
      T_yy += spread[1] * spread[1];
      left[0] -= J[0][column] * fix[column];
      left[1] -= J[1][column] * fix[column];
    }
    const Doubles T_det = T_xx * T_yy - T_xy * T_xy;
    const Doubles distance2 =
        (left[0] * left[0] * T_yy - 2.0 * left[0] * left[1] * T_xy + left[1] * left[1] * T_xx) /
        T_det;
    const Doubles stands = load(residuals.stands + k) * exp_of(-0.5 * distance2) /
                           (6.283185307179586 * root_of(T_det));
    const Doubles weight =
        load(residuals.voice + k) * stands / (stands + load(residuals.otherwise_ppx2 + k));
    const Doubles precision = weight / (S_xx * S_yy - S_xy * S_xy);
    const Doubles P_xx = S_yy * precision, P_xy = -S_xy * precision, P_yy = S_xx * precision;
    for (int row = 0, entry = 0; row < 6; ++row) {
      const Doubles weighed[2] = {P_xx * J[0][row] + P_xy * J[1][row],
                                  P_xy * J[0][row] + P_yy * J[1][row]};
      for (int column = row; column < 6; ++column, ++entry) {
        information[entry] += weighed[0] * J[0][column] + weighed[1] * J[1][column];
      }
      pull[row] += weighed[0] * off[0] + weighed[1] * off[1];
    }
  }
  for (int i = 0; i < 21; ++i) {
    sums.information[i] =
        (information[i][0] + information[i][1]) + (information[i][2] + information[i][3]);
  }
  for (int i = 0; i < 6; ++i) {
    sums.pull[i] = (pull[i][0] + pull[i][1]) + (pull[i][2] + pull[i][3]);
  }
}

#ifdef __AVX2__
/// The numbers of bits that differ between a signature and four others.
inline __attribute__((always_inline)) __m128i bits_apart(const Signature& one,
                                                         const Signature* many, const int* places) {
  const __m256i bits_of =
      _mm256_broadcastsi128_si256(_mm_setr_epi8(0, 1, 1, 2, 1, 2, 2, 3, 1, 2, 2, 3, 2, 3, 3, 4));
  const __m256i low = _mm256_set1_epi8(15), a = _mm256_loadu_si256((const __m256i*)&one);
  __m256i sums[4];  // of the bits of each quarter
  for (int i = 0; i < 4; ++i) {
    const __m256i unlike =
        _mm256_xor_si256(a, _mm256_loadu_si256((const __m256i*)&many[places[i]]));
    const __m256i high = _mm256_srli_epi16(unlike, 4);
    sums[i] =
        _mm256_sad_epu8(_mm256_add_epi8(_mm256_shuffle_epi8(bits_of, _mm256_and_si256(unlike, low)),
                                        _mm256_shuffle_epi8(bits_of, _mm256_and_si256(high, low))),
                        _mm256_setzero_si256());
  }
  const __m256i quarters = _mm256_packs_epi32(_mm256_packs_epi32(sums[0], sums[1]),
                                              _mm256_packs_epi32(sums[2], sums[3]));
  const __m256i halves = _mm256_madd_epi16(quarters, _mm256_set1_epi16(1));
  return _mm_add_epi32(_mm256_castsi256_si128(halves), _mm256_extracti128_si256(halves, 1));
}
#endif

std::size_t alike(const Signature& one, const Signature* many, const int* places, std::size_t count,
                  int most_bits, Alike* found) {
  const auto* a = reinterpret_cast<const std::uint64_t*>(&one);
  std::size_t kept = 0, i = 0;
#ifdef __AVX2__
  for (; i + 4 <= count; i += 4) {
    const __m128i apart = bits_apart(one, many, places + i);
    const __m128i near = _mm_cmpgt_epi32(_mm_set1_epi32(most_bits + 1), apart);
    auto set = static_cast<unsigned>(_mm_movemask_ps((__m128)near));
    if (set == 0) continue;
    int bits[4];
    _mm_storeu_si128((__m128i*)bits, apart);
    for (; set != 0; set &= set - 1) {
      const int lane = __builtin_ctz(set);
      found[kept++] = {places[i + lane], bits[lane]};
    }
  }
#endif
  for (; i < count; ++i) {
    const auto* b = reinterpret_cast<const std::uint64_t*>(many + places[i]);
    const int bits = __builtin_popcountll(a[0] ^ b[0]) + __builtin_popcountll(a[1] ^ b[1]) +
                     __builtin_popcountll(a[2] ^ b[2]) + __builtin_popcountll(a[3] ^ b[3]);
    found[kept] = {places[i], bits};
    kept += bits <= most_bits;
  }
  return kept;
}

/// The numbers of a column with a stride that lie at some indices.
inline __attribute__((always_inline)) Floats gather(const float* from, const Ints& indices) {
#ifdef __AVX2__
  return (Floats)_mm256_i32gather_ps(from, (__m256i)indices, 4);
#else
  Floats values;
  for (std::size_t lane = 0; lane < kLanes; ++lane) values[lane] = from[indices[lane]];
  return values;
#endif
}

/// ln of the density of a share over its largest one.
inline __attribute__((always_inline)) Floats ln_off_of(const ExpectedTrack::Share& first,
                                                       const Ints& indices, float x_px,
                                                       float y_px) {
  const Floats x = x_px - gather(&first.x_px, indices), y = y_px - gather(&first.y_px, indices);
  return -0.5F * (x * x * gather(&first.P_xx, indices) + y * y * gather(&first.P_yy, indices)) -
         x * y * gather(&first.P_xy, indices);
}

void densities(const ExpectedTrack* tracks, const int* which, std::size_t count, float x_px,
               float y_px, float* ln_density, float* ln_off) {
  constexpr int kStride = sizeof(ExpectedTrack) / sizeof(float);
  for (std::size_t i = 0; i < count; i += kLanes) {
    Ints indices;
    __builtin_memcpy(&indices, which + i, sizeof indices);
    indices = before(i, count) ? indices * kStride : Ints{};
    const Floats still = ln_off_of(tracks->still, indices, x_px, y_px);
    const Floats moving = ln_off_of(tracks->moving, indices, x_px, y_px);
    store(larger(still, moving), ln_off + i);
    store(log_of(gather(&tracks->still.most_ppx2, indices) * exp_of(still) +
                 gather(&tracks->moving.most_ppx2, indices) * exp_of(moving) +
                 gather(&tracks->anywhere_ppx2, indices)),
          ln_density + i);
  }
}

constexpr Loops kLoops = {within,       count_within, ranks, ties,        tied_sums, links,
                          exponentials, half_tanh,    votes, normal_sums, densities, alike};

}  // namespace
