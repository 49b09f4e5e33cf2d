/// Feedback of the Circle and Square experts to the Line expert: psi and lambda.
#include <gtest/gtest.h>

#include <map>

#include "filter/kinematics/geometry.h"
#include "filter/line/line.h"
#include "filter/paper/any_filter.h"
#include "tests/filter/items.h"
#include "tests/filter/paper_steps.h"

namespace lcs {
namespace {

using namespace paper;
using testing::AllLayers;
using testing::CircleSteps;
using testing::EdgeSteps;
using testing::SquareSteps;

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
  const PaperCircleParameters p = cars().circle;
  ASSERT_LT(p.trust.critical, p.trust.standard);
  Layers layers;
  layers.normal_circles = {
      circle({100, 100}, p.trust.standard), circle({200, 100}, p.trust.standard - 1),
      circle({300, 100}, p.trust.maximum), circle({400, 100}, p.trust.standard, true)};
  Feedback feedback(p.trust);
  PaperLayers paper;
  feedback.set_regions(layers.normal_circles, layers.squares, paper);
  const auto& [psi, lambda, alpha] = paper;
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
  Feedback feedback({});
  PaperLayers paper;
  feedback.set_regions(layers.normal_circles, layers.squares, paper);
  const std::vector<IgnoreRegion>& psi = paper.ignored;
  ASSERT_EQ(psi.size(), 2u);
  EXPECT_EQ(static_cast<int>(psi[0].shape), 1);  // Ty
  EXPECT_EQ(static_cast<int>(psi[1].shape), 2);
  EXPECT_TRUE(contains(psi[0], {114, 114}));
  EXPECT_FALSE(contains(psi[0], {115, 115}));
  // R_psi are half sizes: the rectangle equals the square.
  EXPECT_TRUE(contains(psi[1], {340, 210}));
  EXPECT_FALSE(contains(psi[1], {341, 200}));
  EXPECT_FALSE(contains(psi[1], {300, 211}));
}

TEST(Psi, ComesBeforeLambda) {
  const std::vector<IgnoreRegion> psi = {{IgnoreRegion::Shape::circle, {100, 100}, {30, 30}}};
  const std::vector<Collector> lambda = {{{120, 100}, 30}};
  const std::vector<Eigen::Vector2f> corners = {{110, 100}, {140, 100}};
  LineExpert line(vga(), {});
  const Chi& chi = line.collect(corners, {}, psi);
  ASSERT_EQ(chi.size(), 1u);
  EXPECT_EQ(chi.sources[0], 1);
  EXPECT_EQ(Feedback({}).group(lambda, chi)[0], 0);
}

Square square_round(const Circle& circle, int trust) {
  Square square;
  square.location = circle.location;
  square.half_size = {circle.radius, circle.radius};
  square.depth_ratio = circle.depth_ratio;
  square.angle = circle.angle;
  square.trust = trust;
  return square;
}

TEST(Psi, IsMadeByNormalCirclesAndSquaresAtTheirMaximumAndByNoRebel) {
  const PaperParameters p;
  const auto edges_at = [](const Vec2& at) {
    return std::vector<Edge>{testing::normal(at), testing::normal(at + Vec2(3, 0)),
                             testing::normal(at + Vec2(0, 3))};
  };
  for (const int short_of_maximum : {1, 2}) {  // a match raises trust by one
    Layers layers;
    layers.normal_circles = {circle({420, 240}, p.circle.trust.maximum - short_of_maximum)};
    layers.normal_edges = edges_at({420, 240});
    layers.squares = {
        square_round(layers.normal_circles[0], p.square.trust.maximum - short_of_maximum)};
    CircleSteps(p.circle, true).update(layers, ahead());
    SquareSteps(p.square, true).update(layers, ahead());
    ASSERT_EQ(layers.normal_circles.size(), 1u);
    ASSERT_EQ(layers.squares.size(), 1u);
    const bool reached = short_of_maximum == 1;
    EXPECT_EQ(layers.normal_circles[0].ignoring, reached);
    EXPECT_EQ(layers.squares[0].ignoring, reached);
    EXPECT_EQ(layers.normal_circles[0].trust, p.circle.trust.maximum - (reached ? 2 : 1));
    EXPECT_EQ(layers.squares[0].trust, p.square.trust.maximum - (reached ? 2 : 1));
  }
  Layers rebels;
  for (Edge& edge : rebels.rebel_edges = edges_at({420, 240})) edge = testing::moved(edge, 0, 80);
  rebels.rebel_circles = {testing::moved(circle({420, 240}, p.circle.trust.maximum), 0, 80)};
  rebels.squares = {square_round(rebels.rebel_circles[0], p.square.trust.maximum)};
  CircleSteps(p.circle, true).update(rebels, ahead());
  SquareSteps(p.square, true).update(rebels, ahead());
  ASSERT_EQ(rebels.rebel_circles.size(), 1u);
  ASSERT_FALSE(rebels.squares.empty());
  EXPECT_EQ(rebels.rebel_circles[0].trust, p.circle.trust.maximum);
  EXPECT_FALSE(rebels.rebel_circles[0].ignoring);
  for (const Square& square : rebels.squares) EXPECT_FALSE(square.ignoring);
}

/// A static world of points, all near the reference depth.
World steady_world(std::uint64_t seed) {
  World world;
  Random random(seed);
  for (int i = 0; i < 150; ++i) {
    world.add({random.uniform(5, 634), random.uniform(5, 474)}, random.uniform(2.6, 3.4));
  }
  return world;
}

/// After the drop, trust needs two frames of evidence to return to the maximum; the ignored frame
/// gives no evidence.
TEST(Psi, LastsOneFrameAndReturnsAfterTwoOthersAtTheEarliest) {
  for (const char* name : {"lab", "cars"}) {
    SCOPED_TRACE(name);
    World world = steady_world(1);
    const EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
    AnyFilter filter(world.camera, preset(name));
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
  const PaperParameters p;
  Layers layers;
  for (int i = 0; i < 5; ++i) {  // edges that coast in psi, nearly equal
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
  const std::vector<IgnoreRegion> psi = {{IgnoreRegion::Shape::circle, {500, 240}, {60, 60}},
                                         {IgnoreRegion::Shape::circle, {100, 100}, {60, 60}}};
  CircleSteps(p.circle).update(layers, ahead(), psi);
  SquareSteps(p.square).update(layers, ahead(), psi);
  ASSERT_EQ(layers.normal_circles.size(), 2u);
  EXPECT_EQ(layers.normal_circles[0].members, 5);  // counted by the predictions of its edges
  EXPECT_EQ(layers.normal_circles[1].members, 0);
  for (const Circle& c : layers.normal_circles) EXPECT_EQ(c.trust, p.circle.trust.standard);
  ASSERT_EQ(layers.squares.size(), 2u);
  EXPECT_EQ(layers.squares[0].circles, 1);
  EXPECT_EQ(layers.squares[1].circles, 0);
  for (const Square& s : layers.squares) EXPECT_EQ(s.trust, p.square.trust.standard);
}

TEST(Psi, IsNeverAppliedWhenSwitchedOff) {
  PaperParameters p;
  p.ignore = false;
  World world = steady_world(2);
  const EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  PaperFilter filter(world.camera, p);
  for (int k = 0; k < 15; ++k) {
    const FrameResult& result = filter.step(world.corners(), k == 0 ? EgoMotion{} : motion);
    EXPECT_TRUE(result.paper.ignored.empty());
    for (const Verdict verdict : result.verdicts) EXPECT_NE(verdict, Verdict::ignored);
    world.advance(motion);
  }
}

/// lambda and psi come from the previous frame, moved on: both are empty in the first frame, and
/// lambda exists from the second on.
TEST(Lambda, AppearsInTheFrameAfterItsCircles) {
  World world = steady_world(3);
  const EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  PaperFilter filter(world.camera);
  EXPECT_TRUE(filter.step(world.corners(), {}).paper.collectors.empty());
  world.advance(motion);
  EXPECT_FALSE(filter.step(world.corners(), motion).paper.collectors.empty());
}

/// The paper's dimensionality counts the items of all experts.
TEST(Dimensionality, CountsEdgesCirclesAndSquares) {
  AllLayers layers;
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
