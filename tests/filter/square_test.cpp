
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
using testing::circle;
using testing::Random;
using testing::steady_motion;
using testing::vga;

Square square(const Vec2& at, const Vec2& half) {
  Square s;
  s.location = at;
  s.half_size = half;
  return s;
}

TEST(Overlap, IsSymmetricAndWithinItsBounds) {
  Random random(1);
  for (int i = 0; i < 500; ++i) {
    const auto any = [&] {
      return square({random.uniform(0, 100), random.uniform(0, 100)},
                    {random.uniform(0.1, 60), random.uniform(0.1, 60)});
    };
    const Square a = any(), b = any();
    EXPECT_DOUBLE_EQ(overlap_percent(a, b), overlap_percent(b, a));
    EXPECT_GE(overlap_percent(a, b), 0);
    EXPECT_LE(overlap_percent(a, b), 100);
  }
}

TEST(Overlap, IsZeroForDisjointFullForContainedAndZeroWithoutArea) {
  const Square big = square({50, 50}, {40, 40});
  EXPECT_DOUBLE_EQ(overlap_percent(big, square({60, 40}, {10, 5})), 100);
  EXPECT_DOUBLE_EQ(overlap_percent(big, big), 100);
  EXPECT_DOUBLE_EQ(overlap_percent(big, square({150, 50}, {40, 40})), 0);
  // A gap in both axes would become a positive area without its signs.
  EXPECT_DOUBLE_EQ(overlap_percent(big, square({150, 150}, {40, 40})), 0);
  EXPECT_DOUBLE_EQ(overlap_percent(big, square({50, 50}, {0, 10})), 0);
}

TEST(Overlap, IsTheShareOfTheSmaller) {
  // Half of the small square sticks out.
  EXPECT_DOUBLE_EQ(overlap_percent(square({0, 0}, {100, 100}), square({100, 0}, {10, 10})), 50);
}

TEST(Parting, OnlyASlowerCircleOnTheSegmentParts) {
  const Circle a = circle({100, 100}, 20, 1.0), b = circle({300, 100}, 20, 1.0);
  EXPECT_TRUE(parts(circle({200, 105}, 20, 0.3), a, b));   // farther away, and in between
  EXPECT_FALSE(parts(circle({200, 105}, 20, 1.5), a, b));  // nearer: it occludes them
  EXPECT_FALSE(parts(circle({200, 150}, 20, 0.3), a, b));  // beside the segment
  EXPECT_FALSE(parts(circle({340, 100}, 20, 0.3), a, b));  // behind b
  EXPECT_FALSE(parts(circle({60, 100}, 20, 0.3), a, b));   // behind a
  EXPECT_TRUE(parts(circle({200, 105}, 20, 0.3), b, a));
}

struct Layering : ::testing::Test {
  std::vector<Square> squares(std::vector<Circle> circles) {
    Layers layers;
    layers.normal_circles = std::move(circles);
    SquareSteps expert;
    expert.update(layers, ahead());
    return layers.squares;
  }
};

TEST_F(Layering, AlignedCirclesOfOneDepthAreOneSquareRoundTheirExtents) {
  const auto found = squares({circle({480, 220}, 15, 1), circle({540, 260}, 10, 1)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].location.isApprox(Vec2(507.5, 237.5)));
  EXPECT_TRUE(found[0].half_size.isApprox(Vec2(42.5, 32.5)));
  EXPECT_EQ(found[0].circles, 2);
  EXPECT_EQ(found[0].trust, PaperParameters{}.square.trust.standard);
}

TEST_F(Layering, CirclesAtARightAngleAboutTheOriginAreACouple) {
  const Vec2 o = vga().centre_px;
  EXPECT_EQ(squares({circle(o + Vec2(120, 0), 15, 1), circle(o + Vec2(0, 120), 15, 1)}).size(), 1u);
  // 60 degrees is neither a corner nor aligned.
  EXPECT_EQ(
      squares({circle(o + Vec2(120, 0), 15, 1), circle(o + 120 * unit_vector(kPi / 3), 15, 1)})
          .size(),
      2u);
}

TEST_F(Layering, CirclesOfDifferentDepthStayApart) {
  EXPECT_EQ(squares({circle({480, 220}, 15, 1), circle({540, 260}, 10, 2)}).size(), 2u);
}

TEST_F(Layering, AFartherCircleBetweenThemPartsACouple) {
  const auto found = squares(
      {circle({420, 240}, 10, 1.5), circle({600, 240}, 10, 1.5), circle({510, 242}, 20, 0.5)});
  EXPECT_EQ(found.size(), 3u);
}

TEST_F(Layering, MinorCirclesInsideJoinAndTheLastCircleIsASquareToo) {
  const auto found = squares({circle({420, 240}, 10, 1), circle({600, 240}, 10, 1),
                              circle({510, 240}, 5, 1), circle({100, 60}, 12, 1)});
  ASSERT_EQ(found.size(), 2u);
  EXPECT_EQ(found[0].circles + found[1].circles, 4);
}

TEST(SquarePrediction, IsTheHomothetyOfAStaticPatch) {
  // The patch is a rectangle at constant depth: its edges are the projections of its corners.
  const double depth = 4, dt = 0.1;
  const Vector3d v(0.05, -0.02, 0.6);
  const MotionField field(vga(), steady_motion(v, Vector3d::Zero(), dt), FieldParameters{});
  const auto edge_px = [&](const Vec2& px) {
    return testing::project(vga(), testing::back_project(vga(), px, depth) - v * dt);
  };
  Layers layers;
  Square s = square({450, 300}, {40, 25});
  s.origin = *field.foe();
  s.depth_ratio = FieldParameters{}.reference_depth_m / depth;
  layers.squares = {s};
  SquareSteps().predict(layers, field);
  const Vec2 low = edge_px({410, 275}), high = edge_px({490, 325});
  EXPECT_TRUE(layers.squares[0].location.isApprox(Vec2(0.5 * (low + high)), 1e-6));
  EXPECT_TRUE(layers.squares[0].half_size.isApprox(Vec2(0.5 * (high - low)), 1e-5));
}

TEST(SquareTrust, RisesWhileMatchedAndFallsWhileNot) {
  const TrustRanks ranks = PaperParameters{}.square.trust;
  SquareSteps expert;
  Layers layers;
  layers.normal_circles = {circle({480, 220}, 15, 1), circle({540, 260}, 10, 1)};
  expert.update(layers, ahead());
  expert.update(layers, ahead());
  ASSERT_EQ(layers.squares.size(), 1u);
  EXPECT_EQ(layers.squares[0].trust, ranks.standard + 1);
  layers.normal_circles.clear();
  int frames = 0;
  while (!layers.squares.empty() && frames < 20) {
    EXPECT_GE(layers.squares[0].trust, ranks.critical);
    expert.update(layers, ahead());
    ++frames;
  }
  EXPECT_EQ(frames, ranks.standard + 1 - ranks.critical + 1);
}

}  // namespace
}  // namespace lcs
