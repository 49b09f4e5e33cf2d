#include "filter/links.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "filter/filter.h"
#include "filter/geometry.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::Random;
using testing::steady_motion;
using testing::vga;
using testing::World;

MotionField ahead() {
  return {vga(), steady_motion({0, 0, 0.5}, Vector3d::Zero(), 0.1), FieldParameters{}};
}

/// A grid of normal edges, `depth_m` away and known to about 1 %.
void add_patch(Layers& layers, const Vec2& low, const Vec2& high, double depth_m,
               double spacing_px = 10) {
  for (double y = low.y(); y <= high.y(); y += spacing_px) {
    for (double x = low.x(); x <= high.x(); x += spacing_px) {
      Edge edge;
      edge.location = {x, y};
      edge.origin = vga().centre_px;
      edge.path_ratio = edge.depth_ratio = FieldParameters{}.reference_depth_m / depth_m;
      edge.path_weight = 1e4;
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
      edge.rebel = edge.called = true;
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

TEST(Links, FewEdgesThinGroupsAndUncalledRebelsMakeNoSquare) {
  Layers layers;
  add_patch(layers, {100, 100}, {140, 100}, 3);  // five, and on a line
  add_patch(layers, {100, 300}, {140, 300}, 3);
  add_rebels(layers, {300, 100}, {340, 140}, {80, 0});
  for (Edge& edge : layers.rebel_edges) edge.called = false;
  EXPECT_TRUE(squares_of(layers).empty());
  EXPECT_TRUE(squares_of({}).empty());
}

TEST(Links, ASparseObjectIsOneBeforeADenseBackground) {
  Layers layers;
  add_patch(layers, {203, 203}, {293, 293}, 2, 30);
  add_patch(layers, {180, 180}, {320, 320}, 4, 7);
  const auto is_object = [](const Square& square) {
    return square.location.isApprox(Vec2(248, 248)) && square.half_size.isApprox(Vec2(45, 45));
  };
  EXPECT_EQ(std::ranges::count_if(squares_of(layers), is_object), 1);
  LinkParameters any;
  any.like_neighbours = false;
  const auto squares = LinkLayering(vga(), any).layer(layers, ahead());
  EXPECT_EQ(std::ranges::count_if(squares, is_object), 0);
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
  for (Edge& edge : layers.normal_edges) edge.path_weight = 0;
  EXPECT_TRUE(squares_of(layers).empty());
}

/// What the links rest on: after a while the path tells the depth to a few per cent, from corners
/// that are rounded to whole pixels.
TEST(PathDepth, IsWithinFivePerCentAfterTenFramesOfRoundedCorners) {
  World world;
  Random random(1);
  for (int i = 0; i < 120; ++i) {
    world.add({random.uniform(40, 600), random.uniform(40, 440)}, random.uniform(2, 5));
  }
  const EgoMotion motion = steady_motion({0.3, 0, 0.5}, {0, 0.05, 0}, 0.1);
  Filter filter(world.camera, preset("default"));
  std::vector<double> errors;
  for (int k = 0; k < 12; ++k) {
    std::vector<Eigen::Vector2f> corners = world.corners();
    std::vector<double> depths;
    for (const auto& point : world.points) {
      if (world.image(point)) depths.push_back(point.x_C.z());
    }
    for (auto& x : corners) x = x.array().round();
    const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    if (k == 11) {
      for (const Edge& edge : result.layers.normal_edges) {
        if (edge.corner < 0 || edge.age < 8) continue;
        const double depth = FieldParameters{}.reference_depth_m / edge.path_ratio;
        errors.push_back(std::abs(depth / depths[edge.corner] - 1));
      }
    }
    world.advance(motion);
  }
  ASSERT_GT(errors.size(), 30u);
  std::nth_element(errors.begin(), errors.begin() + errors.size() / 2, errors.end());
  EXPECT_LT(errors[errors.size() / 2], 0.05);
}

}  // namespace
}  // namespace lcs
