/// What the Circle and Square experts hand back to the Line expert: psi and lambda.
#include <gtest/gtest.h>

#include <map>

#include "filter/circles/circle.h"
#include "filter/filter.h"
#include "filter/kinematics/geometry.h"
#include "filter/line/line.h"
#include "filter/paper/corner_grouping.h"
#include "filter/squares/square.h"
#include "tests/filter/items.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::ahead;
using testing::Random;
using testing::steady_motion;
using testing::vga;
using testing::World;

Circle circle(const Vec2& at, int trust, bool ignoring = false) {
  Circle c = testing::circle(at, 20);
  c.trust = trust;
  c.ignoring = ignoring;
  return c;
}

TEST(Lambda, HoldsTheTrustedNormalCirclesThatAreNotIgnored) {
  const CircleParameters p = preset("cars").circle;
  ASSERT_LT(p.trust.critical, p.trust.standard);
  Layers layers;
  layers.normal_circles = {
      circle({100, 100}, p.trust.standard), circle({200, 100}, p.trust.standard - 1),
      circle({300, 100}, p.trust.maximum), circle({400, 100}, p.trust.standard, true)};
  layers.rebel_circles = {circle({500, 100}, p.trust.maximum)};
  std::vector<IgnoreRegion> psi;
  std::vector<Collector> lambda;
  CircleExpert(vga(), p).feed_back(layers, psi, lambda);
  ASSERT_EQ(lambda.size(), 2u);
  EXPECT_EQ(lambda[0].location, Vec2(100, 100));
  EXPECT_EQ(lambda[1].location, Vec2(300, 100));
  EXPECT_DOUBLE_EQ(lambda[0].radius, 20);
  ASSERT_EQ(psi.size(), 1u);
  EXPECT_EQ(psi[0].location, Vec2(400, 100));
}

TEST(Psi, IsADiscOfACircleAndARectangleOfASquare) {
  Layers layers;
  layers.normal_circles = {circle({100, 100}, 3, true)};
  Square square;
  square.location = {300, 200};
  square.half_size = {40, 10};
  layers.squares = {square};
  layers.squares[0].ignoring = true;
  std::vector<IgnoreRegion> psi;
  std::vector<Collector> lambda;
  CircleExpert(vga(), preset("lab").circle).feed_back(layers, psi, lambda);
  SquareExpert(vga(), preset("lab").square).feed_back(layers, psi);
  ASSERT_EQ(psi.size(), 2u);
  EXPECT_EQ(static_cast<int>(psi[0].shape), 1);  // Ty
  EXPECT_EQ(static_cast<int>(psi[1].shape), 2);
  EXPECT_TRUE(contains(psi[0], {114, 114}));
  EXPECT_FALSE(contains(psi[0], {115, 115}));
  // R_psi are half sizes: the rectangle is the square itself.
  EXPECT_TRUE(contains(psi[1], {340, 210}));
  EXPECT_FALSE(contains(psi[1], {341, 200}));
  EXPECT_FALSE(contains(psi[1], {300, 211}));
}

TEST(Psi, ComesBeforeLambda) {
  const std::vector<IgnoreRegion> psi = {{IgnoreRegion::Shape::circle, {100, 100}, {30, 30}}};
  const std::vector<Collector> lambda = {{{120, 100}, 30}};
  const std::vector<Eigen::Vector2f> corners = {{110, 100}, {140, 100}};
  LineExpert line(vga());
  std::vector<Verdict> verdicts;
  Chi chi;
  line.collect(corners, {}, psi, chi, verdicts);
  CornerGrouping().group(lambda, chi);
  ASSERT_EQ(chi.size(), 1u);
  EXPECT_EQ(chi.sources[0], 1);
  EXPECT_EQ(chi.groups[0], 0);
}

TEST(Psi, IsMadeByNormalCirclesAndSquaresAtTheirMaximumAndByNoRebel) {
  const Parameters p = preset("lab");
  Layers layers;
  layers.normal_circles = {circle({100, 100}, p.circle.trust.maximum),
                           circle({200, 100}, p.circle.trust.maximum - 1)};
  layers.rebel_circles = {circle({300, 100}, p.circle.trust.maximum)};
  layers.squares.resize(3);
  layers.squares[0].trust = layers.squares[1].trust = p.square.trust.maximum;
  layers.squares[1].rebel_circles = 1;
  layers.squares[2].trust = p.square.trust.maximum - 1;
  CircleExpert(vga(), p.circle).update_ignorance(layers);
  SquareExpert(vga(), p.square).update_ignorance(layers);
  EXPECT_TRUE(layers.normal_circles[0].ignoring);
  EXPECT_EQ(layers.normal_circles[0].trust, p.circle.trust.maximum - 2);
  EXPECT_FALSE(layers.normal_circles[1].ignoring);
  EXPECT_FALSE(layers.rebel_circles[0].ignoring);
  EXPECT_TRUE(layers.squares[0].ignoring);
  EXPECT_EQ(layers.squares[0].trust, p.square.trust.maximum - 2);
  EXPECT_FALSE(layers.squares[1].ignoring);
  EXPECT_FALSE(layers.squares[2].ignoring);
}

/// A static world of trackable points, all near the reference depth.
World steady_world(std::uint64_t seed) {
  World world;
  Random random(seed);
  for (int i = 0; i < 150; ++i) {
    world.add({random.uniform(5, 634), random.uniform(5, 474)}, random.uniform(2.6, 3.4));
  }
  return world;
}

/// Trust after the fall takes two frames of evidence to come back to the maximum; the frame that is
/// not looked at is none.
TEST(Psi, LastsOneFrameAndReturnsAfterTwoOthersAtTheEarliest) {
  for (const char* name : {"lab", "cars"}) {
    SCOPED_TRACE(name);
    World world = steady_world(1);
    const EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
    Filter filter(world.camera, preset(name));
    std::map<Id, int> circle_made, square_made;
    int returned = 0;
    for (int k = 0; k < 40; ++k) {
      const Layers& layers = filter.step(world.corners(), k == 0 ? EgoMotion{} : motion).layers;
      const auto check = [&](const auto& items, std::map<Id, int>& made) {
        for (const auto& item : items) {
          if (!item.ignoring) continue;
          if (made.count(item.id)) {
            ++returned;
            EXPECT_GE(k - made[item.id], 3) << "frame " << k;
          }
          made[item.id] = k;
        }
      };
      check(layers.normal_circles, circle_made);
      check(layers.squares, square_made);
      world.advance(motion);
    }
    EXPECT_GT(returned, 10) << "the world gave psi nothing to do";
  }
}

TEST(Psi, InsideItALayerNeitherGainsNorLosesTrust) {
  const Parameters p = preset("lab");
  Layers layers;
  for (int i = 0; i < 5; ++i) {  // edges that coast in psi, as alike as can be
    Edge edge;
    edge.location = Vec2(500, 240) + 8 * unit_vector(i);
    edge.origin = vga().centre_px;
    edge.angle = angle_of(edge.location - edge.origin);
    edge.trust = p.circle.trust.standard;
    layers.normal_edges.push_back(edge);
  }
  layers.normal_circles = {circle({500, 240}, p.circle.trust.standard),
                           circle({100, 100}, p.circle.trust.standard)};
  Square square;
  square.half_size = {20, 20};
  square.trust = p.square.trust.standard;
  layers.squares = {square, square};
  layers.squares[0].location = {500, 240};
  layers.squares[1].location = {100, 100};
  layers.ignored = {{IgnoreRegion::Shape::circle, {500, 240}, {60, 60}},
                    {IgnoreRegion::Shape::circle, {100, 100}, {60, 60}}};
  CircleExpert(vga(), p.circle).update(layers, ahead());
  SquareExpert(vga(), p.square).update(layers, ahead());
  ASSERT_EQ(layers.normal_circles.size(), 2u);
  EXPECT_EQ(layers.normal_circles[0].members, 5);  // by what its edges are predicted to do
  EXPECT_EQ(layers.normal_circles[1].members, 0);
  for (const Circle& c : layers.normal_circles) EXPECT_EQ(c.trust, p.circle.trust.standard);
  ASSERT_EQ(layers.squares.size(), 2u);
  EXPECT_EQ(layers.squares[0].circles, 1);
  EXPECT_EQ(layers.squares[1].circles, 0);
  for (const Square& s : layers.squares) EXPECT_EQ(s.trust, p.square.trust.standard);
}

TEST(Psi, IsNeverAppliedWhenSwitchedOff) {
  Parameters p = preset("lab");
  p.line.ignore = false;
  World world = steady_world(2);
  const EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  Filter filter(world.camera, p);
  for (int k = 0; k < 15; ++k) {
    const FrameResult& result = filter.step(world.corners(), k == 0 ? EgoMotion{} : motion);
    EXPECT_TRUE(result.layers.ignored.empty());
    for (const Verdict verdict : result.verdicts) EXPECT_NE(verdict, Verdict::ignored);
    world.advance(motion);
  }
}

/// lambda and psi are those of the frame before, moved on: nothing in the first frame, and lambda
/// from the second on.
TEST(Lambda, AppearsInTheFrameAfterItsCircles) {
  World world = steady_world(3);
  const EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  Filter filter(world.camera, preset("lab"));
  EXPECT_TRUE(filter.step(world.corners(), {}).layers.collectors.empty());
  world.advance(motion);
  EXPECT_FALSE(filter.step(world.corners(), motion).layers.collectors.empty());
}

/// The paper's dimensionality counts what the experts hold.
TEST(Dimensionality, CountsEdgesCirclesAndSquares) {
  Layers layers;
  layers.normal_edges.resize(1);
  layers.rebel_edges.resize(2);
  layers.normal_circles.resize(4);
  layers.rebel_circles.resize(8);
  layers.squares.resize(16);
  layers.chains.resize(32);  // temporary parameters are not counted
  layers.ignored.resize(32);
  layers.collectors.resize(32);
  EXPECT_EQ(layers.dimension(), 31u);
}

}  // namespace
}  // namespace lcs
