#include "filter/squares/links.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>

#include "filter/kinematics/geometry.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::steady_motion;
using testing::vga;

MotionField ahead(const std::optional<Ground>& ground = {}) {
  EgoMotion motion = steady_motion({0, 0, 0.5}, Vector3d::Zero(), 0.1);
  motion.ground = ground;
  return {vga(), motion, FieldParameters{}};
}

/// A grid of normal edges, `depth_m` away and known to about 1 %.
void add_patch(Layers& layers, const Vec2& low, const Vec2& high, double depth_m,
               double spacing_px = 10) {
  for (double y = low.y(); y <= high.y(); y += spacing_px) {
    for (double x = low.x(); x <= high.x(); x += spacing_px) {
      Edge edge;
      edge.location = {x, y};
      edge.origin = vga().centre_px;
      edge.depth_ratio = FieldParameters{}.reference_depth_m / depth_m;
      edge.depth_ratio_sigma = 0.004;
      edge.corner = 0;
      layers.normal_edges.push_back(edge);
    }
  }
}

void add_rebels(Layers& layers, const Vec2& low, const Vec2& high, const Vec2& velocity) {
  for (double y = low.y(); y <= high.y(); y += 10) {
    for (double x = low.x(); x <= high.x(); x += 10) {
      Edge edge;
      edge.location = {x, y};
      edge.id = layers.rebel_edges.size() + 1;
      edge.rebel = true;
      edge.speed = velocity.norm();
      edge.angle = angle_of(velocity);
      edge.corner = 0;
      layers.rebel_edges.push_back(edge);
    }
  }
}

std::vector<Square> squares_of(const Layers& layers) {
  return LinkLayering(vga(), LinkParameters{}).layer(layers, ahead());
}

TEST(Links, APatchAtOneDepthIsOneSquareRoundIt) {
  Layers layers;
  add_patch(layers, {100, 100}, {160, 140}, 3);
  const auto squares = squares_of(layers);
  ASSERT_EQ(squares.size(), 1u);
  EXPECT_TRUE(squares[0].location.isApprox(Vec2(130, 120)));
  EXPECT_TRUE(squares[0].half_size.isApprox(Vec2(30, 20)));
  EXPECT_NEAR(squares[0].depth_ratio, 1.0, 1e-9);
}

TEST(Links, PatchesThatTouchAtDifferentDepthsStayApart) {
  Layers layers;
  add_patch(layers, {100, 100}, {150, 150}, 3);
  add_patch(layers, {160, 100}, {210, 150}, 4.5);
  EXPECT_EQ(squares_of(layers).size(), 2u);
}

TEST(Links, ADistanceParts) {
  Layers layers;
  add_patch(layers, {100, 100}, {150, 150}, 3);
  add_patch(layers, {250, 100}, {300, 150}, 3);
  EXPECT_EQ(squares_of(layers).size(), 2u);
}

/// A wall seen at a slant: every neighbour is within the tolerance, its ends are far apart in
/// depth.
TEST(Links, AChainOfSmallStepsDoesNotJoinNearToFar) {
  Layers layers;
  for (double x = 50; x <= 600; x += 10) add_patch(layers, {x, 200}, {x, 240}, 2 + 0.01 * x);
  for (const Square& square : squares_of(layers)) EXPECT_LT(square.half_size.x(), 140);
}

TEST(Links, RebelsLinkByVelocityAndNotWithStaticOnes) {
  Layers layers;
  add_rebels(layers, {100, 100}, {140, 140}, {80, 0});
  add_rebels(layers, {150, 100}, {190, 140}, {-80, 0});
  add_patch(layers, {100, 150}, {190, 190}, 3);
  const auto squares = squares_of(layers);
  ASSERT_EQ(squares.size(), 3u);
  int rebels = 0;
  for (const Square& square : squares) {
    if (square.rebel_circles == 0) continue;
    ++rebels;
    EXPECT_NEAR(square.speed, 80, 1e-9);
  }
  EXPECT_EQ(rebels, 2);
}

/// Limbs that swing part what moves as one: rebels too are linked farther upwards, where that is
/// known.
TEST(Links, RebelsReachFartherUpwardsThanAcross) {
  const double gap = 1.5 * LinkParameters{}.rebel_reach_rad * vga().focal_px;
  const auto count = [&](const Vec2& offset, const std::optional<Ground>& ground) {
    Layers layers;
    add_rebels(layers, {100, 100}, {140, 140}, {80, 0});
    add_rebels(layers, Vec2(100, 140) + offset, Vec2(140, 180) + offset, {80, 0});
    return LinkLayering(vga(), LinkParameters{}).layer(layers, ahead(ground)).size();
  };
  const Ground ground{.height_m = 0.45};
  EXPECT_EQ(count({0, gap}, ground), 1u);
  EXPECT_EQ(count({40 + gap, 0}, ground), 2u);
  EXPECT_EQ(count({0, gap}, {}), 2u) << "nothing is known of upwards";
}

TEST(Links, ARebelSquareReachesAsFarAsWhatFollowsItsEdges) {
  Layers layers;
  add_rebels(layers, {100, 100}, {140, 140}, {80, 0});
  add_rebels(layers, {400, 100}, {440, 140}, {80, 0});
  layers.rebel_edges.front().corner = -1;  // id 1
  const Id last = layers.rebel_edges.back().id;
  // Of the second body, of an edge that is not seen, of one that is not there any more.
  const std::vector<Follower> followers = {
      {{430, 190}, last}, {{470, 120}, last - 3}, {{50, 50}, 1}, {{600, 400}, last + 1}};
  LinkLayering layering(vga(), LinkParameters{});
  const std::vector<Square> squares = layering.layer(layers, ahead(), followers);
  ASSERT_EQ(squares.size(), 2u);
  EXPECT_TRUE(squares[0].location.isApprox(Vec2(120, 120)));
  EXPECT_TRUE(squares[0].half_size.isApprox(Vec2(20, 20)));
  EXPECT_TRUE(squares[1].location.isApprox(Vec2(435, 145)));
  EXPECT_TRUE(squares[1].half_size.isApprox(Vec2(35, 45)));

  LinkParameters without;
  without.followers = false;
  EXPECT_TRUE(LinkLayering(vga(), without)
                  .layer(layers, ahead(), followers)[1]
                  .half_size.isApprox(Vec2(20, 20)));
}

TEST(Links, FewEdgesThinGroupsAndUnseenRebelsMakeNoSquare) {
  Layers layers;
  add_patch(layers, {100, 100}, {200, 100}, 3);  // on a line
  add_patch(layers, {100, 300}, {160, 300}, 3);  // seven, one less than it takes
  layers.normal_edges.back().location.y() += 30;
  add_rebels(layers, {300, 100}, {340, 140}, {80, 0});
  for (Edge& edge : layers.rebel_edges) edge.corner = -1;
  EXPECT_TRUE(squares_of(layers).empty());
  EXPECT_TRUE(squares_of({}).empty());
}

TEST(Links, AnObjectIsOneBeforeADenseBackground) {
  Layers layers;
  add_patch(layers, {203, 203}, {283, 283}, 2, 20);
  add_patch(layers, {180, 180}, {320, 320}, 4, 7);
  const auto is_object = [](const Square& square) {
    return square.location.isApprox(Vec2(243, 243)) && square.half_size.isApprox(Vec2(40, 40));
  };
  EXPECT_EQ(std::ranges::count_if(squares_of(layers), is_object), 1);
}

/// Bodies are tall before gaps are wide: head and feet are one, neighbours are two.
TEST(Links, ReachFartherUpwardsThanAcross) {
  const double gap = 1.5 * LinkParameters{}.reach_rad * vga().focal_px;
  for (const double roll : {0.0, 0.5}) {  // upwards is where the ground is not
    const Eigen::Rotation2Dd turned(roll);
    const auto count = [&](const Vec2& offset) {
      Layers layers;
      add_patch(layers, {-20, -20}, {20, 20}, 8);
      add_patch(layers, Vec2(-20, -20) + offset, Vec2(20, 20) + offset, 8);
      for (Edge& edge : layers.normal_edges) {
        edge.location = vga().centre_px + turned * edge.location;
      }
      const Vec2 up = turned * Vec2(0, -1);
      return LinkLayering(vga(), LinkParameters{})
          .layer(layers, ahead(Ground{.up_C = {up.x(), up.y(), 0}, .height_m = 0.45}))
          .size();
    };
    EXPECT_EQ(count({40 + gap, 0}), 2u) << roll;
    EXPECT_EQ(count({0, 40 + gap}), 1u) << roll;
  }
}

/// As many metres are more pixels.
TEST(Links, ReachFartherWhereTheyAreNear) {
  for (const double depth : {2.0, 8.0}) {
    Layers layers;
    add_patch(layers, {200, 100}, {380, 280}, depth, 60);
    EXPECT_EQ(squares_of(layers).size(), depth < 3 ? 1u : 0u) << depth;
  }
}

/// A patch of 1 m, seen 8 m away, with its lower side `foot_m` above the ground.
std::size_t squares_at(double foot_m, const std::optional<Ground>& ground) {
  constexpr double kDepth_m = 8, kHeight_m = 0.45;
  const auto row = [](double up_m) {
    return vga().centre_px.y() + vga().focal_px * (kHeight_m - up_m) / kDepth_m;
  };
  Layers layers;
  add_patch(layers, {300, row(foot_m + 1)}, {350, row(foot_m)}, kDepth_m);
  return LinkLayering(vga(), LinkParameters{}).layer(layers, ahead(ground)).size();
}

TEST(Links, WhatReachesHighAboveTheGroundIsSetting) {
  const Ground ground{.height_m = 0.45};
  const double limit_m = LinkParameters{}.max_size - 1;
  EXPECT_EQ(squares_at(0, ground), 1u);
  EXPECT_EQ(squares_at(limit_m - 0.1, ground), 1u);
  EXPECT_EQ(squares_at(limit_m + 0.1, ground), 0u);
  EXPECT_EQ(squares_at(limit_m + 0.1, std::nullopt), 1u) << "no ground, no height";
}

// 200 px wide, and as many metres as its depth makes of them.
TEST(Links, WhatIsLargerThanAnObjectMayBeIsBackground) {
  const double limit_m = LinkParameters{}.max_size * vga().focal_px / 200;
  for (const double share : {0.9, 1.1}) {
    Layers layers;
    add_patch(layers, {200, 100}, {400, 200}, share * limit_m);
    EXPECT_EQ(squares_of(layers).size(), share < 1 ? 1u : 0u);
  }
}

TEST(Links, EdgesWithoutParallaxAreLeftOut) {
  Layers layers;
  add_patch(layers, {100, 100}, {150, 150}, 3);
  for (Edge& edge : layers.normal_edges) {
    edge.depth_ratio_sigma = std::numeric_limits<double>::infinity();
  }
  EXPECT_TRUE(squares_of(layers).empty());
}

}  // namespace
}  // namespace lcs
