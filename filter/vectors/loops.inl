// The loops of vectors.h. Included by a file for each set of instructions, inside of its namespace.

namespace {

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
LCS_INLINE std::size_t append(const Ints& kept, const Floats& values, std::size_t first,
                              int* places, float* to) {
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

#ifdef __AVX2__
/// The numbers of bits that differ between a signature and four others.
LCS_INLINE __m128i bits_apart(const Signature& one, const Signature* many, const int* places) {
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

constexpr Loops kLoops = {within, count_within, ranks,     ties,  tied_sums,
                          links,  exponentials, half_tanh, votes, alike};

}  // namespace
