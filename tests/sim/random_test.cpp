#include "sim/base/random.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

namespace lcs::sim {
namespace {

using Block = std::array<std::uint32_t, 4>;

std::vector<double> normals(RandomStream stream, int n) {
  std::vector<double> values(n);
  for (double& x : values) x = stream.normal();
  return values;
}

double correlation(const std::vector<double>& a, const std::vector<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum / static_cast<double>(a.size());
}

// The known answers distributed with Random123 (kat_vectors, philox4x32 with 10 rounds).
TEST(Philox, GivesTheKnownAnswersOfItsAuthors) {
  EXPECT_EQ(philox4x32({0, 0, 0, 0}, {0, 0}),
            (Block{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  EXPECT_EQ(philox4x32({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
            (Block{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(philox4x32({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Block{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(RandomStream, RepeatsFromItsSeedAndName) {
  EXPECT_EQ(normals(RandomStream(7, "imu0"), 100), normals(RandomStream(7, "imu0"), 100));
}

TEST(RandomStream, DiffersByOneBitOfTheSeedOrOneLetterOfTheName) {
  const int n = 100'000;
  const auto reference = normals(RandomStream(7, "imu0"), n);
  // The correlation of independent streams has a standard deviation of 1 / sqrt(n).
  const double bound = 5 / std::sqrt(n);
  EXPECT_LT(std::abs(correlation(reference, normals(RandomStream(6, "imu0"), n))), bound);
  EXPECT_LT(std::abs(correlation(reference, normals(RandomStream(7, "imu1"), n))), bound);
}

TEST(RandomStream, UniformFillsTheUnitIntervalEvenly) {
  RandomStream stream(1, "uniform");
  const int n = 1'000'000;
  std::vector<int> bins(100);
  for (int i = 0; i < n; ++i) {
    const double x = stream.uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    ++bins[static_cast<std::size_t>(x * 100)];
  }
  double chi2 = 0;
  for (const int count : bins) chi2 += (count - 1e4) * (count - 1e4) / 1e4;
  // 99 degrees of freedom: mean 99, standard deviation 14.
  EXPECT_LT(chi2, 99 + 5 * 14);
  EXPECT_GT(chi2, 99 - 5 * 14);
}

TEST(RandomStream, NormalFollowsTheNormalDistribution) {
  const int n = 1'000'000;
  std::vector<double> x = normals(RandomStream(1, "normal"), n);
  std::sort(x.begin(), x.end());
  double largest_gap = 0;
  for (int i = 0; i < n; ++i) {
    const double cdf = std::erfc(-x[i] / std::numbers::sqrt2) / 2;
    largest_gap = std::max({largest_gap, std::abs(cdf - i / 1e6), std::abs(cdf - (i + 1) / 1e6)});
  }
  // Kolmogorov-Smirnov: exceeded by one sample in 10,000.
  EXPECT_LT(largest_gap, 2.23 / std::sqrt(n));
  // The tails reach as far as those of a million normals: P(|x| > 4.4) = 1e-5.
  EXPECT_LT(x.front(), -4.4);
  EXPECT_GT(x.back(), 4.4);
}

TEST(RandomStream, NeighboursInASequenceAreIndependent) {
  const int n = 1'000'000;
  const auto x = normals(RandomStream(1, "normal"), n + 2);
  for (const int lag : {1, 2}) {
    double sum = 0;
    for (int i = 0; i < n; ++i) sum += x[i] * x[i + lag];
    EXPECT_LT(std::abs(sum / n), 5 / std::sqrt(n)) << "lag " << lag;
  }
}

// The promise is the same bits on every machine, so the bits are constants here.
TEST(RandomStream, GivesTheseBitsOnEveryMachine) {
  RandomStream stream(1, "imu0.gyro.white");
  EXPECT_EQ(stream.bits(), 0x800489ba8e4ed8f7u);
  EXPECT_EQ(stream.uniform(), 0x1.8e84503f5fe74p-1);
  const std::vector<double> expected = {-0x1.106784e30abfbp+0, 0x1.7e1c57c7b3b5cp-1,
                                        -0x1.28d7afd75a013p+1, -0x1.501e3beb87417p+0};
  EXPECT_EQ(normals(stream, 4), expected);
}

}  // namespace
}  // namespace lcs::sim
