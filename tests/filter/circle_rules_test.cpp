/// The conditions of "Normal Edge Circling" and "Rebel Edge Circling", each tested at its bounds.
#include <gtest/gtest.h>

#include <algorithm>

#include "filter/kinematics/geometry.h"
#include "tests/filter/items.h"
#include "tests/filter/paper_steps.h"

namespace lcs {
namespace {

using namespace paper;
using testing::CircleSteps;
using testing::EdgeSteps;
using testing::SquareSteps;

using testing::ahead;
using testing::normal;
using testing::Random;
using testing::rebel;
using testing::vga;

const PaperCircleParameters kLab;
const TrustRanks kRanks = kLab.trust;

std::vector<Circle> circles_of(std::vector<Edge> edges) {
  Layers layers;
  (edges.front().rebel ? layers.rebel_edges : layers.normal_edges) = std::move(edges);
  CircleSteps(kLab).update(layers, ahead());
  return layers.normal_circles.empty() ? layers.rebel_circles : layers.normal_circles;
}

// Three copies of an edge, at most 1 px apart.
std::vector<Edge> three(const Edge& edge) {
  std::vector<Edge> edges(3, edge);
  edges[1].location += Vec2(1, 0);
  edges[2].location += Vec2(0, 1);
  return edges;
}
std::vector<Edge> both(std::vector<Edge> a, const std::vector<Edge>& b) {
  a.insert(a.end(), b.begin(), b.end());
  return a;
}

TEST(EdgeCondition, DirectionsMayDifferByEpsilonBetaAndNoMore) {
  const auto found = [](double turn, bool rebels) {
    Edge a = rebels ? rebel({400, 200}, 1, 80) : normal({400, 200}), b = a;
    b.angle = wrap_angle(a.angle + turn);
    return circles_of(both(three(a), three(b))).size();
  };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(found(sign * 19 * kDegree, false), 1u);
    EXPECT_EQ(found(sign * 21 * kDegree, false), 2u);
    EXPECT_EQ(found(sign * 49 * kDegree, true), 1u);
    EXPECT_EQ(found(sign * 51 * kDegree, true), 2u);
  }
}

/// The print bounds |V'| <= |V| + eps V_v on one side only; the result would depend on edge order.
TEST(EdgeCondition, VelocitiesMayDifferByEpsilonVWhicheverEdgeIsChosenFirst) {
  for (const int slow_trust : {3, 5}) {  // the most trusted edge is the chosen one
    const auto found = [&](double difference) {
      Edge slow = normal({400, 200}, 1), fast = normal({400, 200}, 1 + difference);
      slow.trust = slow_trust;
      return circles_of(both(three(slow), three(fast))).size();
    };
    EXPECT_EQ(found(0.39), 1u);
    EXPECT_EQ(found(0.41), 2u);
  }
}

TEST(EdgeCondition, RebelsVelocitiesAreBoundLikewise) {
  const double v_v = ahead().reference_speed({400, 200});
  for (const int slow_trust : {3, 5}) {
    const auto found = [&](double difference) {
      Edge slow = rebel({400, 200}, 1, 0.1 * v_v), fast = rebel({400, 200}, 1, 0);
      fast.speed = slow.speed + difference;
      slow.trust = slow_trust;
      return circles_of(both(three(slow), three(fast))).size();
    };
    EXPECT_EQ(found(0.95 * v_v), 1u);  // 100 % of V_v
    EXPECT_EQ(found(1.2 * v_v), 2u);
  }
}

/// V grows with the distance from the focus; edges of one depth have equal V / V_v.
TEST(EdgeCondition, EdgesOfOneDepthAreAlikeThoughTheirSpeedsAreNot) {
  const Vec2 o = vga().centre_px;
  const std::vector<Edge> edges = {normal(o + Vec2(8, 0)), normal(o + Vec2(25, 0)),
                                   normal(o + Vec2(45, 0))};
  ASSERT_GT(edges[2].speed, 5 * edges[0].speed);
  EXPECT_EQ(circles_of(edges).size(), 1u);
}

TEST(EdgeCondition, UntrustedEdgesMakeNoCircle) {
  Edge edge = normal({400, 200});
  edge.trust = kRanks.standard - 1;
  EXPECT_TRUE(circles_of(three(edge)).empty());
}

TEST(MeanCircle, IsTheMeanOfItsEdgesAndHoldsThem) {
  Random random(1);
  for (int i = 0; i < 100; ++i) {
    const Vec2 at(random.uniform(60, 580), random.uniform(60, 420));
    const double heading = random.uniform(-kPi, kPi);
    std::vector<Edge> edges;
    Vec2 location = Vec2::Zero();
    double speed = 0, turn = 0;
    for (int e = 0; e < 5; ++e) {
      const double off = random.uniform(-0.3, 0.3);
      edges.push_back(rebel(at + Vec2(random.uniform(-15, 15), random.uniform(-15, 15)),
                            wrap_angle(heading + off), random.uniform(80, 100)));
      edges.back().mu = random.uniform(0.1, 0.3);  // the unsigned deviation does not turn the mean
      location += edges.back().location / 5;
      speed += edges.back().speed / 5;
      turn += off / 5;
    }
    const auto found = circles_of(edges);
    ASSERT_EQ(found.size(), 1u);
    EXPECT_TRUE(found[0].location.isApprox(location, 1e-9));
    EXPECT_NEAR(found[0].speed, speed, 1e-9);
    // The circular mean equals the plain mean to third order for a small fan of angles.
    EXPECT_NEAR(angle_between(found[0].angle, heading + turn), 0, 0.02);
    for (const Edge& edge : edges) {
      EXPECT_LE((edge.location - found[0].location).norm(), found[0].radius);
    }
  }
}

/// A predicted circle, and the circles after a frame in which `edges` were found.
struct CircleMatch : ::testing::Test {
  Circle predicted(const Vec2& at, double radius) {
    Circle c;
    c.id = 100;
    c.location = at;
    c.origin = vga().centre_px;
    c.radius = radius;
    c.angle = angle_of(at - c.origin);
    c.trust = kRanks.standard;
    return c;
  }
  /// Trust of the predicted circle after the frame, and whether it took the edges.
  std::pair<int, bool> after(const Circle& circle, std::vector<Edge> edges) {
    layers = {};
    const bool rebels = edges.front().rebel;
    (rebels ? layers.rebel_circles : layers.normal_circles) = {circle};
    (rebels ? layers.rebel_edges : layers.normal_edges) = std::move(edges);
    CircleSteps(kLab).update(layers, ahead());
    const Circle& first = (rebels ? layers.rebel_circles : layers.normal_circles).front();
    EXPECT_EQ(first.id, 100u);
    return {first.trust, first.members > 0};
  }
  Layers layers;
};

/// Five edges in a row; `inside` of them lie in the disc of radius 20 px about (400, 200).
std::vector<Edge> row_of_five(int inside) {
  std::vector<Edge> edges;
  for (int i = 0; i < 5; ++i) edges.push_back(normal({i < inside ? 415 - 2.0 * i : 421 + i, 200}));
  return edges;
}

/// The print has "< rho_c", although the text calls rho_c a minimum.
TEST_F(CircleMatch, NeedsTheLeastOverlapAndTakesItExactly) {
  EXPECT_FALSE(after(predicted({400, 200}, 20), row_of_five(1)).second);  // 20 %
  EXPECT_TRUE(after(predicted({400, 200}, 20), row_of_five(2)).second);   // 40 %: rho_c
  EXPECT_TRUE(after(predicted({400, 200}, 20), row_of_five(5)).second);
}

TEST_F(CircleMatch, NeedsALikeVelocity) {
  for (const double sign : {-1.0, 1.0}) {
    Circle circle = predicted({400, 200}, 20);
    circle.depth_ratio = 2;
    EXPECT_TRUE(after(circle, three(normal({400, 200}, 2 + sign * 0.69))).second);
    EXPECT_FALSE(after(circle, three(normal({400, 200}, 2 + sign * 0.71))).second);
  }
}

/// The print bounds one side only: V_m <= V_c + eps_v,r V_v.
TEST_F(CircleMatch, RebelsNeedALikeVelocityOnEitherSide) {
  const double v_v = ahead().reference_speed({400, 200});
  const auto taken = [&](double predicted_speed, double found_speed) {
    Circle circle = predicted({400, 200}, 20);
    circle.rebel = true;
    circle.angle = 1;
    circle.speed = predicted_speed * v_v;
    return after(circle, three(rebel({400, 200}, 1, found_speed * v_v))).second;
  };
  EXPECT_TRUE(taken(0.1, 1.05));
  EXPECT_TRUE(taken(1.05, 0.1));
  EXPECT_FALSE(taken(0.1, 1.3));
  EXPECT_FALSE(taken(1.3, 0.1));
}

TEST_F(CircleMatch, AnAlignedOneGainsTrustAndADeviatingOneLosesItThoughBothAreTaken) {
  for (const double turn : {-19.0, 19.0, -21.0, 21.0, 170.0}) {
    SCOPED_TRACE(turn);
    Circle circle = predicted({400, 200}, 20);
    circle.angle = wrap_angle(circle.angle + turn * kDegree);
    const auto [trust, taken] = after(circle, three(normal({400, 200})));
    EXPECT_TRUE(taken);
    EXPECT_EQ(trust, std::abs(turn) < 20 ? kRanks.standard + 1 : kRanks.standard - 1);
  }
}

TEST_F(CircleMatch, LocationRadiusAndAngleAreEstimatedByTheTrustOfTheFrameBefore) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    Circle circle = predicted({random.uniform(100, 540), random.uniform(100, 380)}, 30);
    circle.angle = wrap_angle(circle.angle + random.uniform(-0.3, 0.3));
    circle.trust = kRanks.critical + 1 + static_cast<int>(random.uniform(0, 2.999));
    const Vec2 at = circle.location + Vec2(random.uniform(-9, 9), random.uniform(-9, 9));
    if ((at - vga().centre_px).norm() < 60) continue;
    auto edges = three(normal(at));
    for (Edge& edge : edges) edge.origin += Vec2(random.uniform(-5, 5), random.uniform(-5, 5));
    const Circle mean = circles_of(edges).front();
    after(circle, edges);
    const Circle& now = layers.normal_circles.front();
    const double w = circle.trust - kRanks.critical;
    EXPECT_TRUE(now.location.isApprox(Vec2((w * circle.location + mean.location) / (w + 1)), 1e-9));
    EXPECT_NEAR(now.radius, (w * circle.radius + mean.radius) / (w + 1), 1e-9);
    EXPECT_NEAR(wrap_angle(now.angle - circle.angle),
                wrap_angle(mean.angle - circle.angle) / (w + 1), 1e-9);
    EXPECT_DOUBLE_EQ(now.depth_ratio, mean.depth_ratio);
    EXPECT_DOUBLE_EQ(now.speed, mean.speed);
    EXPECT_EQ(now.origin, mean.origin);
  }
}

TEST(NewCircle, StartsWithTheTrustOfItsKind) {
  ASSERT_NE(kRanks.initial_normal(), kRanks.initial_rebel());
  EXPECT_EQ(circles_of(three(normal({400, 200}))).front().trust, kRanks.initial_normal());
  EXPECT_EQ(circles_of(three(rebel({400, 200}, 1, 80))).front().trust, kRanks.initial_rebel());
}

TEST_F(CircleMatch, CircleOutsideTheImageIsDeleted) {
  for (const Vec2& outside : {Vec2(-5, 200), Vec2(645, 200), Vec2(300, -5), Vec2(300, 485)}) {
    layers = {};
    layers.normal_circles = {predicted(outside, 20), predicted({300, 200}, 20)};
    CircleSteps(kLab).update(layers, ahead());
    ASSERT_EQ(layers.normal_circles.size(), 1u);
    EXPECT_EQ(layers.normal_circles[0].location, Vec2(300, 200));
  }
}

/// beta^ of a rebel circle is the mean angle of its edges, whatever its trust.
TEST_F(CircleMatch, TheAngleOfARebelCircleIsThatOfItsEdges) {
  Circle circle = predicted({400, 200}, 20);
  circle.rebel = true;
  circle.angle = 1;
  circle.speed = 80;
  circle.trust = kRanks.maximum;
  after(circle, three(rebel({400, 200}, 1.4, 80)));
  EXPECT_NEAR(layers.rebel_circles.front().angle, 1.4, 1e-9);
}

/// The circles are the same in any order of the edges.
TEST(Circles, DoNotDependOnTheOrderOfTheEdges) {
  Random random(3);
  std::vector<Edge> edges;
  for (int i = 0; i < 200; ++i) {
    edges.push_back(
        normal({random.uniform(0, 639), random.uniform(0, 479)}, random.uniform(0.5, 1.5)));
    edges.back().trust = 3 + i % 3;
    edges.back().age = i;  // no two edges equal, so none is first only by its place in the list
  }
  const auto centres = [](const std::vector<Circle>& circles) {
    std::vector<std::pair<double, double>> list;
    for (const Circle& c : circles) list.emplace_back(c.location.x(), c.location.y());
    std::sort(list.begin(), list.end());
    return list;
  };
  const auto forward = centres(circles_of(edges));
  std::reverse(edges.begin(), edges.end());
  const auto backward = centres(circles_of(edges));
  ASSERT_GT(forward.size(), 3u);
  ASSERT_EQ(forward.size(), backward.size());
  for (std::size_t i = 0; i < forward.size(); ++i) {  // sums are added in another order
    EXPECT_NEAR(forward[i].first, backward[i].first, 1e-9);
    EXPECT_NEAR(forward[i].second, backward[i].second, 1e-9);
  }
}

}  // namespace
}  // namespace lcs
