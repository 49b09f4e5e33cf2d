#include "filter/types/trust.h"

#include <gtest/gtest.h>

#include "filter/kinematics/camera.h"
#include "filter/paper/estimate.h"

namespace lcs {
namespace {

using namespace paper;

TEST(Trust, InitialValuesFollowThePaperForItsTables) {
  const TrustRanks lab_circle{2, 3, 5}, lab_square{3, 5, 7}, cars_circle{1, 4, 7};
  EXPECT_EQ(lab_circle.initial_normal(), 3);   // (2 + 3) / 2, rounded
  EXPECT_EQ(cars_circle.initial_normal(), 3);  // (1 + 4) / 2, rounded
  EXPECT_EQ(lab_circle.initial_rebel(), 5);    // above Tr_s
  EXPECT_GT(cars_circle.initial_rebel(), cars_circle.standard);
  EXPECT_EQ(lab_square.initial_square(), 5);  // Tr_s
}

TEST(Trust, NoInitialValueExceedsTheMaximum) {
  const TrustRanks tight{2, 3, 3};
  EXPECT_EQ(tight.initial_normal(), 3);
  EXPECT_EQ(tight.initial_rebel(), 3);
  EXPECT_LE(tight.after_ignoring(), tight.maximum);
  EXPECT_GE(tight.after_ignoring(), tight.critical);
}

TEST(Trust, RisesToTheMaximumAndDiesBelowTheCritical) {
  const TrustRanks ranks{2, 3, 5};
  int trust = 3;
  for (int i = 0; i < 10; ++i) trust = ranks.raised(trust);
  EXPECT_EQ(trust, 5);
  EXPECT_TRUE(ranks.alive(2));
  EXPECT_FALSE(ranks.alive(1));
}

TEST(Trust, EstimateTakesTheMeasurementAtTheCriticalTrust) {
  const TrustRanks ranks{2, 3, 5};
  EXPECT_DOUBLE_EQ(estimate(2, ranks, 10.0, 4.0), 4.0);
}

TEST(Trust, EstimateFollowsMoreSlowlyTheMoreTrusted) {
  const TrustRanks ranks{2, 3, 5};
  EXPECT_DOUBLE_EQ(estimate(3, ranks, 10.0, 4.0), 7.0);
  EXPECT_DOUBLE_EQ(estimate(5, ranks, 10.0, 4.0), (3 * 10.0 + 4.0) / 4);
  EXPECT_TRUE(Vec2(estimate(4, ranks, Vec2(3, 0), Vec2(0, 3))).isApprox(Vec2(2, 1)));
}

}  // namespace
}  // namespace lcs
