/// The conditions of "Geometric Layering", "Mean Square" and "Square Estimation", each at its
/// bounds.
#include <gtest/gtest.h>

#include <algorithm>
#include <tuple>

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
using testing::circle;
using testing::Random;
using testing::vga;

const PaperSquareParameters kLab;
const TrustRanks kRanks = kLab.trust;

Circle rebel(const Vec2& at, double radius, double angle, double speed) {
  return testing::moved(circle(at, radius), angle, speed);
}

std::vector<Square> squares_of(std::vector<Circle> circles,
                               const PaperSquareParameters& parameters = kLab) {
  Layers layers;
  for (Circle& c : circles) (c.rebel ? layers.rebel_circles : layers.normal_circles).push_back(c);
  SquareSteps(parameters).update(layers, ahead());
  return layers.squares;
}

/// Number of squares of two close circles of one depth whose directions differ by `turn`.
std::size_t couples_at(double angle, double turn) {
  Circle a = circle({400, 200}, 10), b = circle({430, 200}, 10);
  a.angle = angle;
  b.angle = wrap_angle(angle + turn);
  return squares_of({a, b}).size();
}

TEST(Couple, IsAlignedWithinEpsilonBeta2OrARightAngleWithinEpsilonBeta1) {
  for (const double angle : {0.0, kPi - 0.01, -kPi + 0.01, kPi / 2, -2.0}) {  // across +-180 too
    for (const double sign : {-1.0, 1.0}) {
      SCOPED_TRACE(angle);
      for (const auto& [degrees, squares] : {std::pair{0.0, 1},
                                             {34.0, 1},
                                             {36.0, 2},
                                             {74.0, 2},
                                             {76.0, 1},
                                             {90.0, 1},
                                             {104.0, 1},
                                             {106.0, 2},
                                             {180.0, 2}}) {
        EXPECT_EQ(couples_at(angle, sign * degrees * kDegree), static_cast<std::size_t>(squares))
            << sign * degrees;
      }
    }
  }
}

TEST(Couple, HasOneVelocityWithinEpsilonVOnEitherSide) {
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_EQ(squares_of({circle({400, 200}, 9, 2), circle({430, 200}, 9, 2 + sign * 0.69)}).size(),
              1u);
    EXPECT_EQ(squares_of({circle({400, 200}, 9, 2), circle({430, 200}, 9, 2 + sign * 0.71)}).size(),
              2u);
  }
}

TEST(Couple, MayMixNormalAndRebelUnlessToldOtherwise) {
  const Circle a = circle({400, 240}, 10);
  const Circle b = rebel({430, 240}, 10, 0, ahead().reference_speed({430, 240}));
  EXPECT_EQ(squares_of({a, b}).size(), 1u);
  EXPECT_EQ(squares_of({a, b}).front().rebel_circles, 1);
  PaperSquareParameters apart = kLab;
  apart.mix_kinds = false;
  EXPECT_EQ(squares_of({a, b}, apart).size(), 2u);
}

TEST(Couple, IsTheFurthestOneNearerThanTheStartOfDt) {
  std::vector<Circle> in_line;
  for (const double x : {350.0, 420.0, 500.0, 600.0}) in_line.push_back(circle({x, 240}, 5));
  const auto all = squares_of(in_line);
  ASSERT_EQ(all.size(), 1u);
  EXPECT_NEAR(all[0].half_size.x(), (605 - 345) / 2.0, 1e-9);
  EXPECT_EQ(all[0].circles, 4);
  PaperSquareParameters near = kLab;
  near.d_t = 160.0 / 800;  // of the diagonal of 640 x 480
  const auto some = squares_of(in_line, near);
  ASSERT_EQ(some.size(), 2u);
  EXPECT_NEAR(some[0].half_size.x(), (505 - 345) / 2.0, 1e-9);
  EXPECT_EQ(some[0].circles, 3);
}

// --------------------------------------------------------------------------------------------- d_t

/// asin(R_b' / d_ab') >= beta_m means that the segment from a to b meets the disc of b'.
TEST(PartingCondition, IsThatTheSegmentCrossesASlowerCircle) {
  Random random(1);
  int crossing = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto anywhere = [&] { return Vec2(random.uniform(0, 640), random.uniform(0, 480)); };
    const Circle a = circle(anywhere(), 10), b = circle(anywhere(), 10);
    Circle c = circle(anywhere(), random.uniform(5, 60), random.uniform(0.5, 1.5));
    const Vec2 ab = (b.location - a.location).normalized(), ac = c.location - a.location;
    const double along = ac.dot(ab), aside = std::abs(cross(ab, ac));
    const bool between = along > 0 && along < (b.location - a.location).norm();
    if (std::abs(aside - c.radius) < 1e-6) continue;
    const bool crosses = c.depth_ratio <= a.depth_ratio && between && aside < c.radius;
    crossing += crosses;
    EXPECT_EQ(parts(c, a, b), crosses);
  }
  EXPECT_GT(crossing, 20);
}

TEST(PartingCondition, CircleOfLikeSpeedDoesNotPartACouple) {
  const std::vector<Circle> row = {circle({420, 240}, 10, 1.5), circle({600, 240}, 10, 1.5),
                                   circle({510, 240}, 20, 1.2)};
  EXPECT_EQ(squares_of(row).size(), 1u);
}

TEST(PartingCondition, LeavesTheCirclesBeyondTheReducedDtOut) {
  // a, a near partner, then a far wall (slow), then two circles of a's depth behind it.
  const auto found =
      squares_of({circle({350, 240}, 8, 2), circle({400, 240}, 8, 2), circle({480, 240}, 25, 0.4),
                  circle({560, 240}, 8, 2), circle({620, 240}, 8, 2)});
  ASSERT_EQ(found.size(), 3u);
  for (const Square& square : found) {
    const double left = square.location.x() - square.half_size.x();
    const double right = square.location.x() + square.half_size.x();
    EXPECT_TRUE(right < 455 || left > 500 || (left > 454 && right < 506)) << left << " " << right;
  }
}

/// d_t = d_t - d_bb': from 300 px to 170, which also excludes partners within d_ab off the line.
TEST(PartingCondition, ReducesDtByTheDistanceOfThePartingCircleFromB) {
  const Vec2 a_px(100, 100);
  PaperSquareParameters p = kLab;
  p.d_t = 300.0 / 800;
  const auto partners_of_a = [&](double distance_of_c) {
    std::vector<Circle> circles = {circle(a_px, 8, 2), circle(a_px + Vec2(280, 0), 8, 2),
                                   circle(a_px + Vec2(150, 0), 20, 0.4),
                                   circle(a_px + distance_of_c * unit_vector(kPi / 3), 8, 2)};
    for (Circle& c : circles) c.angle = 0;
    circles[0].trust = 5;
    return squares_of(circles, p).front().circles - 1;
  };
  EXPECT_EQ(partners_of_a(160), 1);
  EXPECT_EQ(partners_of_a(180), 0);
}

// ------------------------------------------------------------------------------------- mean square

TEST(MeanSquare, HasTheExtentsOfItsCirclesAndWeighsAAsMuchAsAllOfB) {
  Random random(2);
  for (int i = 0; i < 100; ++i) {
    // a and the furthest b on a ray, and a minor circle between them.
    const double angle = random.uniform(-kPi, kPi);
    const Vec2 o = vga().centre_px, along = unit_vector(angle);
    std::vector<Circle> circles;
    for (const double r : {60.0, 130.0, 200.0}) {
      circles.push_back(circle(o + r * along, random.uniform(3, 12), random.uniform(1, 1.3)));
      circles.back().origin = o + Vec2(random.uniform(-1, 1), random.uniform(-1, 1));
    }
    circles[0].trust = 5;  // processed first: C_a
    const auto found = squares_of(circles);
    ASSERT_EQ(found.size(), 1u);
    const Square& s = found[0];
    EXPECT_EQ(s.circles, 3);
    Vec2 low = Vec2::Constant(1e9), high = Vec2::Constant(-1e9);
    for (const Circle& c : circles) {
      low = low.cwiseMin(Vec2(c.location.array() - c.radius));
      high = high.cwiseMax(Vec2(c.location.array() + c.radius));
    }
    EXPECT_TRUE(s.location.isApprox(0.5 * (low + high), 1e-9));
    EXPECT_TRUE(s.half_size.isApprox(0.5 * (high - low), 1e-9));
    const auto half = [&](double a, double b1, double b2) { return 0.5 * (a + 0.5 * (b1 + b2)); };
    EXPECT_NEAR(s.speed, half(circles[0].speed, circles[1].speed, circles[2].speed), 1e-9);
    EXPECT_NEAR(s.depth_ratio,
                half(circles[0].depth_ratio, circles[1].depth_ratio, circles[2].depth_ratio), 1e-9);
    const Vec2 origin = 0.5 * (circles[0].origin + 0.5 * (circles[1].origin + circles[2].origin));
    EXPECT_TRUE(s.origin.isApprox(origin, 1e-9));
    // beta of a static square is the direction of the flow at its own centre.
    EXPECT_NEAR(angle_between(s.angle, angle_of(s.location - o)), 0, 1e-9);
  }
}

TEST(MeanSquare, OfRebelsGoesWhereTheyGoAcrossPlusMinus180Degrees) {
  for (const double heading : {kPi, -kPi + 0.01, 0.0, 1.0}) {
    const auto found = squares_of({rebel({300, 200}, 10, wrap_angle(heading + 0.1), 90),
                                   rebel({340, 200}, 10, wrap_angle(heading - 0.1), 90)});
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].rebel_circles, 2);
    EXPECT_NEAR(angle_between(found[0].angle, heading), 0, 1e-9);
  }
}

TEST(MinorCircle, JoinsWhenInsideAtOneVelocityAndAligned) {
  // A couple on the diagonal from the focus, and a minor circle in their square, beside the line
  // between them (a slower circle on that line would part them).
  const Vec2 o = vga().centre_px;
  const std::vector<Circle> couple = {circle(o + Vec2(40, 40), 8), circle(o + Vec2(160, 160), 8)};
  const auto members = [&](const Circle& minor) {
    auto circles = couple;
    for (Circle& c : circles) c.trust = 5;
    circles.push_back(minor);
    const auto found = squares_of(circles);
    return *std::max_element(found.begin(), found.end(), [](const Square& a, const Square& b) {
      return a.circles < b.circles;
    });
  };
  const Circle inside = circle(o + Vec2(130, 80), 5);
  EXPECT_EQ(members(inside).circles, 3);
  for (const double sign : {-1.0, 1.0}) {
    Circle turned = inside;
    turned.angle = (45 + sign * 19) * kDegree;
    EXPECT_EQ(members(turned).circles, 3);
    turned.angle = (45 + sign * 21) * kDegree;
    EXPECT_EQ(members(turned).circles, 2);
    Circle other = inside;
    other.depth_ratio = 1 + sign * 0.69;
    EXPECT_EQ(members(other).circles, 3);
    other.depth_ratio = 1 + sign * 0.71;
    EXPECT_EQ(members(other).circles, 2);
  }
  // Outside, though near and similar.
  EXPECT_EQ(members(circle(o + Vec2(100, 180), 5)).circles, 2);
}

TEST(MinorCircle, MustBeNearerThanDt) {
  // The circle lies in the extent of b, beyond b's centre.
  std::vector<Circle> circles = {circle({400, 240}, 5), circle({500, 240}, 30),
                                 circle({525, 240}, 2)};
  circles[0].trust = 5;
  PaperSquareParameters p = kLab;
  p.d_t = 110.0 / 800;
  EXPECT_EQ(squares_of(circles, p).front().circles, 2);
  p.d_t = 124.0 / 800;
  EXPECT_EQ(squares_of(circles, p).front().circles, 2);
}

TEST(MinorCircle, IsOfTheSameKindWhereKindsDoNotMix) {
  const double v_v = ahead().reference_speed({450, 240});
  std::vector<Circle> circles = {circle({400, 240}, 10), circle({500, 240}, 10),
                                 rebel({450, 242}, 5, 0, v_v)};
  circles[0].trust = circles[1].trust = 5;
  EXPECT_EQ(squares_of(circles).front().circles, 3);
  PaperSquareParameters apart = kLab;
  apart.mix_kinds = false;
  EXPECT_EQ(squares_of(circles, apart).front().circles, 2);
}

TEST(MeanSquare, ACircleWithoutAPartnerIsASquareByItself) {
  const auto found = squares_of({circle({500, 300}, 14)});
  ASSERT_EQ(found.size(), 1u);
  EXPECT_TRUE(found[0].location.isApprox(Vec2(500, 300)));
  EXPECT_TRUE(found[0].half_size.isApprox(Vec2(14, 14)));
  EXPECT_EQ(found[0].trust, kRanks.standard);
}

TEST(MeanSquare, CirclesThatCoastBringNone) {
  Circle c = circle({500, 300}, 14);
  c.members = 0;
  EXPECT_TRUE(squares_of({c}).empty());
}

TEST(Layers, SquaresDoNotDependOnTheOrderOfTheCircles) {
  Random random(3);
  std::vector<Circle> circles;
  for (int i = 0; i < 40; ++i) {
    circles.push_back(circle({random.uniform(0, 640), random.uniform(0, 480)},
                             random.uniform(5, 20), random.uniform(0.3, 3)));
    circles.back().members = 3 + i;  // no two equal, so none is first only by its place
  }
  const auto sorted = [](const std::vector<Square>& squares) {
    std::vector<std::tuple<double, double, double, double>> list;
    for (const Square& s : squares) {
      list.emplace_back(s.location.x(), s.location.y(), s.half_size.x(), s.half_size.y());
    }
    std::sort(list.begin(), list.end());
    return list;
  };
  const auto forward = sorted(squares_of(circles));
  std::reverse(circles.begin(), circles.end());
  EXPECT_EQ(forward, sorted(squares_of(circles)));
  EXPECT_GT(forward.size(), 5u);
}

// --------------------------------------------------------------------------------------- matching

/// A predicted square, and the frame that finds the static circle under it.
struct SquareMatch : ::testing::Test {
  const Circle found = circle({480, 300}, 20, 2);
  Square predicted() const {
    Square s;
    s.id = 100;
    s.location = found.location;
    s.half_size = {20, 20};
    s.origin = found.origin;
    s.depth_ratio = found.depth_ratio;
    s.angle = found.angle;
    s.trust = kRanks.standard;
    return s;
  }
  /// Trust of the predicted square after the frame, and whether it took the circle.
  std::pair<int, bool> after(const Square& square) {
    layers = {};
    layers.squares = {square};
    layers.normal_circles = {found};
    SquareSteps(kLab).update(layers, ahead());
    EXPECT_EQ(layers.squares.front().id, 100u);
    return {layers.squares.front().trust, layers.squares.front().circles > 0};
  }
  Layers layers;
};

/// The print has "- eps" as the second bound on beta.
TEST_F(SquareMatch, DirectionCountsOnBothSidesAndAcrossPlusMinus180Degrees) {
  for (const double turn : {-19.0, -1.0, 0.0, 1.0, 19.0, -21.0, 21.0, 180.0}) {
    SCOPED_TRACE(turn);
    Square square = predicted();
    square.angle = wrap_angle(square.angle + turn * kDegree);
    const auto [trust, taken] = after(square);
    EXPECT_TRUE(taken);
    EXPECT_EQ(trust, std::abs(turn) < 20 ? kRanks.standard + 1 : kRanks.standard - 1);
  }
}

TEST_F(SquareMatch, VelocityCountsOnBothSides) {
  for (const double sign : {-1.0, 1.0}) {
    Square square = predicted();
    square.depth_ratio += sign * 0.69;
    EXPECT_TRUE(after(square).second);
    square = predicted();
    square.depth_ratio += sign * 0.71;
    EXPECT_FALSE(after(square).second);
  }
}

TEST_F(SquareMatch, OverlapMustExceedRhoC) {
  Square square = predicted();
  square.location.x() += 0.59 * 40;  // 41 % of 40 px overlap
  EXPECT_TRUE(after(square).second);
  square.location.x() = found.location.x() - 0.61 * 40;
  EXPECT_FALSE(after(square).second);
  EXPECT_EQ(layers.squares.size(), 2u);  // the circle is a new square then
}

TEST_F(SquareMatch, SquareOutsideTheImageIsDeleted) {
  for (const Vec2& outside : {Vec2(-5, 200), Vec2(645, 200), Vec2(300, -5), Vec2(300, 485)}) {
    layers = {};
    layers.squares = {predicted(), predicted()};
    layers.squares[0].location = outside;
    SquareSteps(kLab).update(layers, ahead());
    ASSERT_EQ(layers.squares.size(), 1u);
    EXPECT_EQ(layers.squares[0].location, found.location);
  }
}

TEST_F(SquareMatch, LocationAndSizeAreEstimatedByTheTrustOfTheFrameBefore) {
  Random random(4);
  for (int i = 0; i < 100; ++i) {
    Square square = predicted();
    square.location += Vec2(random.uniform(-8, 8), random.uniform(-8, 8));
    square.half_size += Vec2(random.uniform(-5, 5), random.uniform(-5, 5));
    square.trust = kRanks.critical + static_cast<int>(random.uniform(0, 4.999));
    square.angle += random.uniform(-0.3, 0.3);
    square.speed = 1;
    square.origin = {1, 1};
    square.rebel_circles = 1;  // it belonged to a rebel before
    ASSERT_TRUE(after(square).second);
    const Square& now = layers.squares.front();
    const double w = square.trust - kRanks.critical;
    EXPECT_TRUE(
        now.location.isApprox(Vec2((w * square.location + found.location) / (w + 1)), 1e-9));
    EXPECT_TRUE(
        now.half_size.isApprox(Vec2((w * square.half_size + Vec2(20, 20)) / (w + 1)), 1e-9));
    EXPECT_DOUBLE_EQ(now.depth_ratio, found.depth_ratio);
    EXPECT_DOUBLE_EQ(now.speed, found.speed);
    EXPECT_EQ(now.origin, found.origin);
    EXPECT_DOUBLE_EQ(now.angle, found.angle);
    EXPECT_EQ(now.rebel_circles, 0);
    EXPECT_EQ(now.trust, std::min(square.trust + 1, kRanks.maximum));
  }
}

}  // namespace
}  // namespace lcs
