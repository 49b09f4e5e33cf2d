/// How many votes chance gives: against corners that are scattered and counted.
#include "filter/vote_chance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>
#include <vector>

#include "filter/point_grid.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using testing::Random;

constexpr double kHit1_px = 2, kHit2_px = 3;
constexpr int kMostVoters = 8;

VoteChance chance(double false_motions) {
  return {kHit1_px, kHit2_px, kMostVoters, false_motions};
}

/// Earlier corners without order.
class Scatter {
 public:
  Scatter(Random& random, double corners_ppx2) {
    const auto count = static_cast<int>(corners_ppx2 * kSide_px * kSide_px);
    for (int i = 0; i < count; ++i)
      corners_.emplace_back(random.uniform(0, kSide_px), random.uniform(0, kSide_px));
    grid_.build(corners_, 16);
  }

  std::optional<Vec2> nearest(const Vec2& x, double within_px) {
    grid_.nearest(
        x, within_px, 1, [](int) { return true; }, near_);
    if (near_.empty()) return std::nullopt;
    return corners_[near_.front().index];
  }

  static constexpr double kSide_px = 600;

 private:
  std::vector<Vec2> corners_;
  PointGrid grid_;
  std::vector<Neighbour> near_;
};

/// Shares of displacements to which chance gives that many votes or more.
std::vector<double> counted(Random& random, double corners_ppx2, int voters) {
  constexpr int kDraws = 40000;
  Scatter once(random, corners_ppx2), twice(random, corners_ppx2);
  std::vector<double> at_least(2 * (voters + 1) + 1, 0.0);
  for (int draw = 0; draw < kDraws; ++draw) {
    const Vec2 x(random.uniform(150, 450), random.uniform(150, 450));
    const Vec2 step(random.uniform(-40, 40), random.uniform(-40, 40));
    int votes = 1 + (twice.nearest(x - 2 * step, kHit2_px) ? 1 : 0);
    for (int i = 0; i < voters; ++i) {
      const Vec2 y = x + Vec2(random.uniform(-60, 60), random.uniform(-60, 60));
      const std::optional<Vec2> before = once.nearest(y - step, kHit1_px);
      if (!before) continue;
      votes += twice.nearest(*before - (y - *before), kHit2_px) ? 2 : 1;
    }
    for (int i = 0; i <= votes; ++i) at_least[i] += 1.0 / kDraws;
  }
  return at_least;
}

TEST(VoteChance, IsThatOfCornersWithoutOrder) {
  Random random(1);
  for (const double corners_ppx2 : {0.0005, 0.002, 0.008, 0.03}) {
    for (const int voters : {2, 5, 8}) {
      const std::vector<double> at_least = counted(random, corners_ppx2, voters);
      for (const double share : {0.3, 0.03, 0.003}) {
        const int least = chance(share).least(corners_ppx2, voters, 1);
        SCOPED_TRACE(::testing::Message() << corners_ppx2 << " a pixel, " << voters << " voters, "
                                          << share << ": " << least << " votes");
        // 40000 displacements of one scatter: their share is a sixth off at the most. The test may
        // count on a fifth more corners than there are, by which 5 votes of 8 are twice as likely.
        if (least < static_cast<int>(at_least.size())) {
          EXPECT_LT(at_least[least], 1.2 * share);
        }
        if (least > 1) {
          EXPECT_GT(at_least[least - 1], share / 3);
        }
      }
    }
  }
}

TEST(VoteChance, TakesMoreVotesWhereCornersAreMoreAndMotionsAreMore) {
  const VoteChance chance = lcs::chance(0.25);
  for (int voters = 0; voters <= kMostVoters; ++voters) {
    int last = 0;
    for (double corners = 1e-6; corners < 1; corners *= 1.7) {
      const int least = chance.least(corners, voters, 100);
      EXPECT_GE(least, last) << corners;
      EXPECT_GE(chance.least(corners, voters, 1000), least);
      EXPECT_LE(lcs::chance(2.5).least(corners, voters, 100), least);
      last = least;
    }
  }
  EXPECT_LT(chance.least(0.0005, 8, 100), chance.least(0.01, 8, 100));
}

TEST(VoteChance, GivesAllWhereEveryPlaceHasACornerAndOneAtTheLeast) {
  const VoteChance chance = lcs::chance(0.25);
  EXPECT_GT(chance.least(10, 8, 10), 18);
  EXPECT_GT(chance.least(std::numeric_limits<double>::infinity(), 8, 10), 18);
  EXPECT_EQ(chance.least(0.001, 8, 0), 1);  // with nothing to choose from
  EXPECT_EQ(lcs::chance(1e6).least(0.001, 8, 100), 1);
  EXPECT_GT(lcs::chance(0).least(0, 8, 1), 18);  // none may be by chance
}

}  // namespace
}  // namespace lcs
