
#include <gtest/gtest.h>

#include "filter/kinematics/geometry.h"
#include "tests/filter/items.h"
#include "tests/filter/paper_steps.h"

namespace lcs {
namespace {

using namespace paper;
using testing::CircleSteps;
using testing::EdgeSteps;
using testing::SquareSteps;

using Eigen::Vector3d;
using testing::ahead;
using testing::normal;
using testing::rebel;
using testing::vga;

struct Circling : ::testing::Test {
  CircleSteps expert;
  Layers layers;
  void update() { expert.update(layers, ahead()); }
};

TEST_F(Circling, NeighboursOfOneDepthAndDirectionAreOneCircleThatHoldsThem) {
  layers.normal_edges = {normal({500, 240}), normal({510, 250}), normal({505, 230})};
  update();
  ASSERT_EQ(layers.normal_circles.size(), 1u);
  const Circle& circle = layers.normal_circles[0];
  EXPECT_EQ(circle.members, 3);
  EXPECT_TRUE(circle.location.isApprox(Vec2(505, 240)));
  for (const Edge& edge : layers.normal_edges) {
    EXPECT_LE((edge.location - circle.location).norm(), circle.radius);
    EXPECT_EQ(edge.circle, 0);
  }
  EXPECT_EQ(circle.trust, PaperParameters{}.circle.trust.initial_normal());
}

TEST_F(Circling, GroupsOfNoneOneAndTwoMakeNoCircle) {
  for (int n = 0; n < 3; ++n) {
    layers = {};
    for (int i = 0; i < n; ++i) layers.normal_edges.push_back(normal({500.0 + i, 240}));
    update();
    EXPECT_TRUE(layers.normal_circles.empty());
  }
}

TEST_F(Circling, CoincidentEdgesAndEdgesOnALineAreCircles) {
  layers.normal_edges = {normal({500, 240}), normal({500, 240}), normal({500, 240}),
                         normal({400, 240}), normal({410, 240}), normal({420, 240})};
  update();
  EXPECT_EQ(layers.normal_circles.size(), 2u);
  for (const Circle& circle : layers.normal_circles) EXPECT_GT(circle.radius, 0);
}

TEST_F(Circling, DifferentDepthsPartNeighbours) {
  layers.normal_edges = {normal({500, 240}, 1), normal({505, 245}, 1), normal({500, 250}, 1),
                         normal({502, 242}, 2), normal({507, 247}, 2), normal({502, 252}, 2)};
  update();
  EXPECT_EQ(layers.normal_circles.size(), 2u);
}

TEST_F(Circling, OppositeEndsOfOneRayAreNotOneLayer) {
  layers.normal_edges = {normal({360, 240}), normal({362, 242}), normal({361, 239}),
                         normal({600, 240}), normal({602, 242}), normal({601, 239})};
  update();
  EXPECT_EQ(layers.normal_circles.size(), 2u);
}

TEST_F(Circling, DirectionsAcrossPlusMinus180DegreesAreAlike) {
  // Left of the FOE beta wraps: one edge just above the axis, two below.
  layers.normal_edges = {normal({200, 236}), normal({205, 243}), normal({198, 244})};
  update();
  ASSERT_EQ(layers.normal_circles.size(), 1u);
  EXPECT_EQ(layers.normal_circles[0].members, 3);
  EXPECT_NEAR(angle_between(layers.normal_circles[0].angle, kPi), 0, 0.05);
}

TEST_F(Circling, RebelsGroupByTheirOwnMotion) {
  layers.rebel_edges = {rebel({300, 200}, kPi - 0.05, 80), rebel({310, 200}, -kPi + 0.05, 85),
                        rebel({305, 210}, kPi, 82), rebel({302, 205}, 0, 80)};
  update();
  ASSERT_EQ(layers.rebel_circles.size(), 1u);
  EXPECT_EQ(layers.rebel_circles[0].members, 3);
  EXPECT_EQ(layers.rebel_edges[3].circle, -1);
}

TEST_F(Circling, AnAlignedMatchRaisesTrustAndAMissLowersItUntilDeletion) {
  const TrustRanks ranks = PaperParameters{}.circle.trust;
  layers.normal_edges = {normal({500, 240}), normal({510, 250}), normal({505, 230})};
  update();
  update();
  ASSERT_EQ(layers.normal_circles.size(), 1u);
  EXPECT_EQ(layers.normal_circles[0].trust, ranks.initial_normal() + 1);
  layers.normal_edges.clear();
  int frames = 0;
  while (!layers.normal_circles.empty() && frames < 20) {
    update();
    ++frames;
    for (const Circle& circle : layers.normal_circles) EXPECT_TRUE(ranks.alive(circle.trust));
  }
  EXPECT_EQ(frames, ranks.initial_normal() + 1 - ranks.critical + 1);
}

TEST_F(Circling, AtTheMaximumACircleIsIgnoredNextAndLookedAtAgainAfter) {
  layers.normal_edges = {normal({500, 240}), normal({510, 250}), normal({505, 230})};
  const TrustRanks ranks = PaperParameters{}.circle.trust;
  CircleSteps ignoring({}, true);
  for (int i = ranks.initial_normal(); i < ranks.maximum + 1; ++i) {
    EXPECT_TRUE(layers.normal_circles.empty() || !layers.normal_circles[0].ignoring);
    ignoring.update(layers, ahead());
  }
  ASSERT_EQ(layers.normal_circles.size(), 1u);
  EXPECT_TRUE(layers.normal_circles[0].ignoring);
  EXPECT_EQ(layers.normal_circles[0].trust, ranks.maximum - 2);
  Feedback feedback(ranks);
  PaperLayers paper;
  feedback.set_regions(layers.normal_circles, {}, paper);
  const auto& [psi, lambda, alpha] = paper;
  ASSERT_EQ(psi.size(), 1u);
  EXPECT_TRUE(lambda.empty());
  EXPECT_TRUE(psi[0].location.isApprox(layers.normal_circles[0].location));
  ignoring.update(layers, ahead());
  EXPECT_FALSE(layers.normal_circles[0].ignoring);
}

TEST_F(Circling, AStaticCircleGrowsAndMovesAsItsDepthSays) {
  const double depth = 2, dt = 0.1;
  const Vector3d v(0, 0, 0.5);
  Circle circle;
  circle.location = {450, 300};
  circle.radius = 20;
  circle.depth_ratio = FieldParameters{}.reference_depth_m / depth;
  layers.normal_circles = {circle};
  expert.predict(layers, ahead());
  const Vec2 expected =
      testing::project(vga(), testing::back_project(vga(), {450, 300}, depth) - v * dt);
  EXPECT_TRUE(layers.normal_circles[0].location.isApprox(expected, 1e-9));
  EXPECT_NEAR(layers.normal_circles[0].radius, 20 * depth / (depth - v.z() * dt), 1e-9);
}

}  // namespace
}  // namespace lcs
