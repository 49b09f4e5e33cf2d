/// The loops over columns: against the formula, and this machine's against plain ones, bit by bit.
#include "filter/vectors/vectors.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

#include "filter/types/signature.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using testing::Random;

const std::vector<const Loops*> kWays = {&loops(), &plain_loops()};

/// A column of numbers, with room behind them that holds anything.
std::vector<float> column(Random& random, std::size_t count, double low, double high) {
  std::vector<float> values;
  for (std::size_t i = 0; i < count + kLanes; ++i) {
    values.push_back(static_cast<float>(random.uniform(low, high)));
  }
  return values;
}

TEST(Loops, FindAndCountThePointsOfARangeWithinARadius) {
  Random random(1);
  const std::vector<float> x = column(random, 50, 0, 100), y = column(random, 50, 0, 100);
  for (const auto& [first, last] :
       std::vector<std::pair<std::size_t, std::size_t>>{{0, 0}, {3, 4}, {0, 8}, {5, 22}, {0, 50}}) {
    for (const float radius2 : {0.0F, 900.0F, 1e6F}) {
      std::vector<int> expected;
      std::vector<float> distances;
      for (std::size_t i = first; i < last; ++i) {
        const float off_x = x[i] - 40, off_y = y[i] - 60;
        const float apart2 = off_x * off_x + off_y * off_y;
        if (apart2 > radius2) continue;
        expected.push_back(static_cast<int>(i));
        distances.push_back(apart2);
      }
      for (const Loops* way : kWays) {
        std::vector<int> found(last - first + kLanes);
        std::vector<float> distance2(last - first + kLanes);
        const std::size_t count = way->within(x.data(), y.data(), first, last, 40, 60, radius2,
                                              found.data(), distance2.data());
        found.resize(count);
        distance2.resize(count);
        EXPECT_EQ(found, expected);
        EXPECT_EQ(distance2, distances);
        EXPECT_EQ(way->count_within(x.data(), y.data(), first, last, 40, 60, radius2), count);
      }
    }
  }
}

TEST(Loops, RanksAreThoseOfAStableSort) {
  Random random(8);
  for (const std::size_t count : {0, 1, 7, 8, 9, 30}) {
    std::vector<float> values = column(random, count, 0, 10);
    for (float& value : values) value = std::floor(value);  // so that some are equal
    std::vector<int> order(count);
    std::iota(order.begin(), order.end(), 0);
    std::ranges::stable_sort(order, {}, [&](int i) { return values[i]; });
    for (const Loops* way : kWays) {
      std::vector<int> places(count + kLanes);
      way->ranks(values.data(), count, places.data());
      for (std::size_t place = 0; place < count; ++place) {
        EXPECT_EQ(places[order[place]], static_cast<int>(place)) << count;
      }
    }
  }
}

TEST(Loops, ExponentialsAreThoseOfTheLibrary) {
  for (const Loops* way : kWays) {
    std::vector<float> values;
    for (int i = -860; i <= 870; ++i) values.push_back(0.1F * static_cast<float>(i));
    const std::vector<float> x = values;
    values.resize(values.size() + kLanes);
    way->exponentials(values.data(), x.size(), -0.5F);
    for (std::size_t i = 0; i < x.size(); ++i) {
      EXPECT_NEAR(values[i] / std::exp(-0.5 * x[i]), 1, 2e-7) << x[i];
    }
  }
}

TEST(Loops, TanhIsThatOfTheLibrary) {
  for (const Loops* way : kWays) {
    std::vector<float> m, found(400 + kLanes);
    for (std::size_t i = 0; i < 400 + kLanes; ++i) {
      m.push_back(0.25F * static_cast<float>(i) - 50);
    }
    way->half_tanh(m.data(), found.data(), 400);
    for (std::size_t i = 0; i < 400; ++i)
      EXPECT_NEAR(found[i], std::tanh(0.5 * m[i]), 2e-7) << m[i];
  }
}

TEST(Loops, VotesAreThoseOfTheFormula) {
  Random random(3);
  const std::vector<std::uint32_t> counts = {3, 0, 11, 7};  // of four corners' pairs
  constexpr std::size_t kPlaces = 11;
  const std::size_t places = kPlaces * counts.size() + kLanes;
  const std::vector<float> x = column(random, places, -9, 9), y = column(random, places, -9, 9);
  const std::vector<float> likeness = column(random, places, 0, 10);
  const std::vector<int> voices = {3, 0, 1, 2, 0, 2, 3, 1, 2};
  const std::vector<float> weights = column(random, voices.size(), 0, 1);
  const std::vector<float> clutter = column(random, voices.size(), -7, -3);
  constexpr float kVariance = 0.5, kShare2 = 0.04F;
  constexpr std::size_t kAsked = 5;
  for (const Loops* way : kWays) {
    std::vector<float> sums(kLanes);
    way->votes({x.data(), y.data(), likeness.data(), counts.data(), kPlaces, kVariance, kShare2},
               voices.data(), weights.data(), clutter.data(), voices.size(), kAsked, sums.data());
    for (std::size_t lane = 0; lane < kLanes; ++lane) {
      const double step_x = x[kAsked + lane], step_y = y[kAsked + lane];
      const double variance = kVariance + kShare2 * (step_x * step_x + step_y * step_y);
      double expected = 0;
      for (std::size_t voice = 0; voice < voices.size(); ++voice) {
        double ratio = 0;
        const std::size_t first = kPlaces * static_cast<std::size_t>(voices[voice]);
        for (std::size_t p = first; p < first + counts[voices[voice]]; ++p) {
          const double apart2 = std::pow(x[p] - step_x, 2) + std::pow(y[p] - step_y, 2);
          ratio = std::max(ratio, std::exp(likeness[p] - apart2 / (2 * variance) - clutter[voice]) /
                                      (2 * std::numbers::pi * variance));
        }
        expected += weights[voice] * std::log((1 + ratio) / 2);
      }
      // Single precision, of terms of up to 20.
      EXPECT_NEAR(sums[lane], expected, 2e-5) << lane;
    }
  }
}

TEST(Loops, SumOverTheTiesOfEachNode) {
  Random random(4);
  constexpr std::size_t kCount = 43;
  const std::vector<float> x = column(random, kCount, 0, 90), y = column(random, kCount, 0, 90);
  const std::vector<float> step = column(random, kCount, -2, 2), no_step(kCount + kLanes);
  std::vector<float> reach2 = column(random, kCount, 100, 200);
  reach2[5] = -1;  // has no ties
  const std::vector<float> variance = column(random, kCount, 0.1, 1);
  const TieColumns nodes = {x.data(),      y.data(),       step.data(),     no_step.data(),
                            reach2.data(), no_step.data(), variance.data(), 9};
  const std::vector<float> values = column(random, kCount, -1, 1);
  std::vector<double> expected(kCount);
  for (std::size_t i = 0; i < kCount; ++i) {
    for (std::size_t j = 0; j < kCount; ++j) {
      const double apart2 = std::pow(x[i] - x[j], 2) + std::pow(y[i] - y[j], 2);
      if (i == j || apart2 > 9 * std::min(reach2[i], reach2[j])) continue;
      const double exponent = apart2 / (reach2[i] + reach2[j]) +
                              std::pow(step[i] - step[j], 2) / (variance[i] + variance[j] + 0.3);
      if (exponent < 9) expected[i] += std::exp(-0.5 * exponent) * values[j];
    }
  }
  EXPECT_EQ(expected[5], 0);
  for (const Loops* way : kWays) {
    std::vector<std::size_t> first;
    std::vector<std::uint32_t> starts(kCount * kCount);
    std::vector<float> weights(kLanes * starts.size()), sums(kCount + kLanes);
    std::size_t end = 0;
    for (std::size_t i = 0; i < kCount; ++i) {
      first.push_back(end);
      if (reach2[i] < 0) continue;
      end += way->ties(nodes, i, 0.3F, i + 1, kCount, &starts[end], &weights[kLanes * end]);
    }
    first.push_back(end);
    way->tied_sums({first.data(), starts.data(), weights.data()}, values.data(), kCount,
                   sums.data());
    // Single precision, of sums of up to 20.
    for (std::size_t i = 0; i < kCount; ++i) EXPECT_NEAR(sums[i], expected[i], 1e-5) << i;
  }
}

TEST(Loops, HaveTheSameBitsOnAnyMachine) {
  Random random(2);
  constexpr std::size_t kCount = 203;
  const std::vector<float> x = column(random, kCount, 0, 200), y = column(random, kCount, 0, 200);
  const std::vector<float> step_x = column(random, kCount, -9, 9);
  const std::vector<float> step_y = column(random, kCount, -9, 9);
  const std::vector<float> reach2 = column(random, kCount, 100, 900);
  const std::vector<float> length2 = column(random, kCount, 0, 10);
  const std::vector<float> variance = column(random, kCount, 0, 2);
  const TieColumns nodes = {x.data(),      y.data(),       step_x.data(),   step_y.data(),
                            reach2.data(), length2.data(), variance.data(), 9};
  const LinkColumns edges = {x.data(), y.data(), reach2.data(), step_x.data(), variance.data(), 9};
  const std::vector<std::uint32_t> counts = {3, 0, 11, 7};  // of four corners' pairs
  const PairColumns pairs = {step_x.data(), step_y.data(), length2.data(), counts.data(), 11, 1,
                             0.04F};
  const std::vector<int> voices = {3, 0, 1, 2, 0, 2, 3, 1, 2};
  std::vector<std::pair<std::vector<std::uint32_t>, std::vector<float>>> tied;
  std::vector<std::pair<std::vector<int>, std::vector<float>>> linked;
  std::vector<std::vector<float>> powers, tanhs, votes;
  for (const Loops* way : kWays) {
    // What a search finds: places and values.
    const auto found = [&](auto&& search) {
      std::pair hits(std::vector<int>(kCount + kLanes), std::vector<float>(kCount + kLanes));
      const std::size_t count = search(hits.first.data(), hits.second.data());
      hits.first.resize(count);
      hits.second.resize(count);
      return hits;
    };
    std::vector<std::uint32_t> starts(kCount);
    std::vector<float> weights(kLanes * kCount);
    const std::size_t blocks = way->ties(nodes, 7, 0.3F, 8, kCount, starts.data(), weights.data());
    starts.resize(blocks);
    weights.resize(kLanes * blocks);
    tied.emplace_back(starts, weights);
    linked.push_back(found([&](int* places, float* distances2) {
      return way->links(edges, 7, 900, 8, kCount, places, distances2);
    }));
    EXPECT_GT(tied.back().first.size(), 5u);
    EXPECT_GT(linked.back().first.size(), 0u);
    votes.emplace_back(kLanes);
    way->votes(pairs, voices.data(), length2.data(), variance.data(), voices.size(), 13,
               votes.back().data());
    powers.push_back(step_x);
    way->exponentials(powers.back().data(), kCount, 3);
    powers.back().resize(kCount);
    tanhs.emplace_back(kCount + kLanes);
    way->half_tanh(step_y.data(), tanhs.back().data(), kCount);
    tanhs.back().resize(kCount);
  }
  EXPECT_EQ(linked[0], linked[1]);
  EXPECT_EQ(tied[0], tied[1]);
  EXPECT_EQ(votes[0], votes[1]);
  EXPECT_EQ(powers[0], powers[1]);
  EXPECT_EQ(tanhs[0], tanhs[1]);
}

TEST(Loops, FindSignaturesByTheirDistance) {
  Random random(5);
  std::vector<Signature> many(50);
  for (Signature& signature : many) {
    for (std::uint64_t& word : signature) {
      for (int bit = 0; bit < 64; ++bit) word = word << 1 | (random.uniform(0, 1) < 0.5);
    }
  }
  const Signature one = many[7];
  std::vector<int> places;  // every second one
  for (int i = 1; i < 50; i += 2) places.push_back(i);
  std::vector<Alike> found(places.size());
  for (const int most : {-1, 0, 120, 128, 256}) {
    std::vector<std::pair<int, int>> expected;
    for (const int i : places) {
      int bits = 0;
      for (int k = 0; k < 256; ++k)
        bits += static_cast<int>(((one[k / 64] ^ many[i][k / 64]) >> (k % 64)) & 1);
      EXPECT_EQ(distance(one, many[i]), bits);
      if (bits <= most) expected.emplace_back(i, bits);
    }
    for (const Loops* way : {&loops(), &plain_loops()}) {
      std::vector<std::pair<int, int>> in_order;
      const std::size_t count =
          way->alike(one, many.data(), places.data(), places.size(), most, found.data());
      for (const Alike& here : std::span(found).first(count)) {
        in_order.emplace_back(here.place, here.bits);
      }
      EXPECT_EQ(in_order, expected) << most;
    }
  }
}

}  // namespace
}  // namespace lcs
