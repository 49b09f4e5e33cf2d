/// The paper's estimates and initial values, each compared with the formula evaluated here, for
/// random landmarks, corners and motions.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "filter/kinematics/geometry.h"
#include "tests/filter/paper_steps.h"

namespace lcs {
namespace {

using namespace paper;
using testing::AllLayers;
using testing::CircleSteps;
using testing::EdgeSteps;
using testing::SquareSteps;

using Eigen::Vector3d;
using testing::Random;
using testing::steady_motion;
using testing::vga;

const PaperEdgeParameters kLab;
const TrustRanks kRanks = PaperCircleParameters{}.trust;

Chi chi_of(std::vector<Vec2> corners) {
  Chi chi;
  for (std::size_t i = 0; i < corners.size(); ++i) chi.sources.push_back(static_cast<int>(i));
  chi.locations = std::move(corners);
  return chi;
}

/// A frame of the paper's rule without the Line expert.
std::vector<Verdict> step(EdgeSteps& experts, AllLayers& layers, const std::vector<Vec2>& corners,
                          const MotionField& field, int group = -1) {
  experts.predict(layers, field);
  return experts.update(layers, chi_of(corners), std::vector<int>(corners.size(), group), field);
}

/// The field of a camera that moves to the left.
MotionField to_the_right() {
  return {vga(), steady_motion({-0.5, 0, 0}, Vector3d::Zero(), 0.1), FieldParameters{}};
}

/// A trusted normal edge.
Edge edge_with_radius(double mu) {
  Edge edge;
  edge.location = {300, 240};
  edge.mu = mu;
  edge.trust = 4;
  return edge;
}

/// A random normal edge under a random motion of the camera, and the next frame.
struct NormalEstimates : ::testing::Test {
  struct Case {
    Edge edge;
    MotionField field;
    Vec2 rotated, along, predicted;
    double ratio, step;  // V~ / V_v, and V_v t_f, px
  };

  Case any() {
    for (;;) {
      Edge edge;
      edge.location = {random.uniform(100, 540), random.uniform(100, 380)};
      edge.depth_ratio = random.uniform(0.3, 2.5);
      edge.trust = kRanks.critical + static_cast<int>(random.uniform(0, 3.999));
      edge.mu = random.uniform(8, 25);
      const EgoMotion motion = steady_motion(
          {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-1, 1)},
          random.vector(0.1), 0.1);
      const MotionField field(vga(), motion, FieldParameters{});
      Case c{edge, field, field.rotated(edge.location), {}, {}, 0, 0};
      c.along = field.direction(c.rotated);
      c.ratio = 0.5 * (edge.depth_ratio + 1);
      c.step = field.reference_speed(c.rotated) * 0.1;
      c.predicted = c.rotated + c.ratio * c.step * c.along;
      // A frame with depth information, away from the FOE.
      if (c.step > 3 && (c.rotated - field.origin(c.rotated)).norm() > 60) return c;
    }
  }

  /// The edge after a frame with a corner at its prediction plus (ahead, aside).
  Edge after(const Case& c, double ahead, double aside, Verdict expected = Verdict::normal) {
    AllLayers layers;
    layers.normal_edges = {c.edge};
    corner = c.predicted + ahead * c.along + aside * Vec2(-c.along.y(), c.along.x());
    const auto verdicts = step(experts, layers, {corner}, c.field);
    EXPECT_EQ(verdicts[0], expected);
    return layers.normal_edges.empty() ? Edge{} : layers.normal_edges.front();
  }

  Random random{1};
  EdgeSteps experts;
  Vec2 corner;
};

TEST_F(NormalEstimates, TheVelocityIsPredictedHalfwayToTheVehicles) {
  for (int i = 0; i < 200; ++i) {
    const Case c = any();
    AllLayers layers;
    layers.normal_edges = {c.edge};
    experts.predict(layers, c.field);
    const Edge& edge = layers.normal_edges[0];
    const double v_v = c.field.reference_speed(c.rotated);
    EXPECT_NEAR(edge.speed, 0.5 * (c.edge.depth_ratio * v_v + v_v), 1e-9);
    EXPECT_TRUE(edge.predicted.isApprox(c.predicted, 1e-12));
  }
}

TEST_F(NormalEstimates, TheLocationIsWeighedByTheTrustOfTheFrameBefore) {
  for (int i = 0; i < 200; ++i) {
    const Case c = any();
    const Edge edge = after(c, random.uniform(0, 2), random.uniform(-3, 3));
    const double weight = c.edge.trust - kRanks.critical;
    EXPECT_TRUE(edge.location.isApprox(Vec2((weight * c.predicted + corner) / (weight + 1)), 1e-9));
  }
}

TEST_F(NormalEstimates, TheVelocityIsThePredictedOnePlusTheSignedResidual) {
  for (int i = 0; i < 200; ++i) {
    Case c = any();
    c.edge.trust = std::max(c.edge.trust, kRanks.standard);  // it may fall short and still survive
    const double ahead = random.uniform(-std::min(4.0, c.ratio * c.step), 3);
    const Edge edge = after(c, ahead, random.uniform(-3, 3));
    EXPECT_NEAR(edge.depth_ratio, std::abs(c.ratio + ahead / c.step), 1e-9);
    EXPECT_NEAR(edge.speed, edge.depth_ratio * c.field.reference_speed(edge.location), 1e-9);
  }
}

TEST_F(NormalEstimates, TheRadiusGoesHalfwayToTheOffsetFromTheVehiclesSpeedAsALength) {
  for (int i = 0; i < 200; ++i) {
    const Case c = any();
    const Edge edge = after(c, random.uniform(0, 2), random.uniform(-3, 3));
    const double printed = 0.5 * (std::abs(1 - c.ratio) * c.step + c.edge.mu);  // Cor = 1
    EXPECT_NEAR(edge.mu, std::clamp(printed, kLab.mu_min, kLab.mu_max), 1e-9);
  }
}

TEST_F(NormalEstimates, TheAngleIsThatOfTheFlowAtTheEstimate) {
  for (int i = 0; i < 200; ++i) {
    const Case c = any();
    const Edge edge = after(c, random.uniform(0, 2), random.uniform(-3, 3));
    const Vec2 from_focus = edge.location - c.field.origin(edge.location);
    const bool reverse = from_focus.dot(c.along) < 0;
    EXPECT_NEAR(angle_between(edge.angle, angle_of(reverse ? Vec2(-from_focus) : from_focus)), 0,
                1e-6);
  }
}

TEST_F(NormalEstimates, TrustRisesAtThePredictionAndFallsShortOfItAndWithoutACorner) {
  for (int i = 0; i < 200; ++i) {
    Case c = any();
    c.edge.trust = std::max(c.edge.trust, kRanks.standard);
    EXPECT_EQ(after(c, 1, 0).trust, std::min(c.edge.trust + 1, kRanks.maximum));
    if (c.ratio * c.step > 4) {
      EXPECT_EQ(after(c, -3, 0).trust, c.edge.trust - 1);
    }
    // Outside its radius, outside its span, or against the field: the edge gets no corner.
    EXPECT_EQ(after(c, 0, c.edge.mu + 1, Verdict::pending).trust, c.edge.trust - 1);
    EXPECT_EQ(after(c, -c.ratio * c.step - 3, 0, Verdict::pending).trust, c.edge.trust - 1);
  }
}

TEST_F(NormalEstimates, AtTheCriticalTrustOneMissDeletesAndNothingIsDividedByZero) {
  Case c = any();
  c.edge.trust = kRanks.critical;
  AllLayers layers;
  layers.normal_edges = {c.edge};
  step(experts, layers, {}, c.field);
  EXPECT_TRUE(layers.normal_edges.empty());
  EXPECT_TRUE(after(c, 1, 0).location.isApprox(corner));  // the estimate is the corner itself
}

/// Cor = 1 - rho^2 of the corners of the landmark's group inside its radius.
TEST_F(NormalEstimates, CorWidensTheRadiusWhereTheGroupLiesOnALine) {
  const MotionField field = to_the_right();
  Edge edge = edge_with_radius(20);
  edge.depth_ratio = 1.4;
  const double step_px = field.reference_speed(edge.location) * 0.1;
  const Vec2 predicted = edge.location + Vec2(1.2 * step_px, 0);
  const auto radius = [&](const std::vector<Vec2>& offsets, int others_group) {
    std::vector<Vec2> corners;
    for (const Vec2& offset : offsets) corners.push_back(predicted + offset);
    std::vector<int> groups(corners.size(), others_group);
    groups[0] = 7;
    AllLayers layers;
    layers.normal_edges = {edge};
    experts.predict(layers, field);
    experts.update(layers, chi_of(corners), groups, field);
    return layers.normal_edges[0].mu;
  };
  const double off = 0.2 * step_px;
  const std::vector<Vec2> spread = {{0, 0}, {12, -9}, {3, 13}, {-10, 8}, {6, -14}};
  double sx = 0, sy = 0, xx = 0, yy = 0, xy = 0;
  for (const Vec2& o : spread) {
    sx += o.x() / 5, sy += o.y() / 5;
  }
  for (const Vec2& o : spread) {
    xx += (o.x() - sx) * (o.x() - sx);
    yy += (o.y() - sy) * (o.y() - sy);
    xy += (o.x() - sx) * (o.y() - sy);
  }
  EXPECT_NEAR(radius(spread, 7), 0.5 * (off / (1 - xy * xy / (xx * yy)) + 20), 1e-9);
  EXPECT_NEAR(radius(spread, 3), 0.5 * (off + 20), 1e-9);  // other groups have no influence
  const std::vector<Vec2> line = {{0, 0}, {12, 12}, {-8, -8}, {10, 10}};
  EXPECT_DOUBLE_EQ(radius(line, 7), kLab.mu_max);                      // Cor = 0
  EXPECT_NEAR(radius({{0, 0}, {12, 12}}, 7), 0.5 * (off + 20), 1e-9);  // two have no correlation
}

/// Fixed point of V~ = (V + V_v)/2 and V^ = V~ +- |residual|/t_f: the residual settles at
/// (w+1)/(w+2) |V - V_v| t_f, w = Tr - Tr_c, and V^ differs from V by 2(w+1)/(w+2) of V's distance
/// from V_v. Only at Tr = Tr_c does V^ equal V.
TEST(PaperVelocity, SettlesBesideTheTrueOneTheMoreSoTheMoreTrusted) {
  const EgoMotion motion = steady_motion({-0.5, 0, 0}, Vector3d::Zero(), 0.05);
  const MotionField field(vga(), motion, FieldParameters{});
  const double step_px = field.reference_speed({300, 240}) * motion.dt_s;
  for (const int maximum : {2, 3, 5}) {
    PaperParameters p;
    p.circle.trust = {2, 2, maximum};
    p.edge.mu_min = p.edge.mu_max;  // the radius does not matter here
    EdgeSteps experts(p);
    AllLayers layers;
    const double ratio = 2.5;
    double x = 20;
    for (int k = 0; k < 60; ++k, x += ratio * step_px) step(experts, layers, {{x, 240}}, field);
    ASSERT_EQ(layers.normal_edges.size(), 1u);
    const Edge& edge = layers.normal_edges[0];
    EXPECT_EQ(edge.age, 59);
    const double w = maximum - 2;
    EXPECT_NEAR(edge.depth_ratio, 1 + 2 * (w + 1) / (w + 2) * (ratio - 1), 1e-6);
  }
}

/// Lifetimes, in frames, of the edges of one corner that moves right at a steady `ratio` of V_v.
std::vector<int> lives(double ratio) {
  const MotionField field = to_the_right();
  const double step_px = field.reference_speed({300, 240}) * 0.1;  // 7 px
  EdgeSteps experts;
  AllLayers layers;
  std::vector<int> lived;
  for (double x = 20; x < 600; x += ratio * step_px) {
    step(experts, layers, {{x, 240}}, field);
    for (const Edge& edge : layers.normal_edges) {
      if (edge.age == 0) lived.push_back(0);
      if (edge.corner >= 0) lived.back() = edge.age + 1;
    }
  }
  lived.pop_back();  // the last one's end is not observed
  return lived;
}

/// Consequence for landmarks away from Z_ref. A farther one falls short by more than a corner's
/// noise in each frame, which costs trust (xi_3) until it is gone; it never gains any.
TEST(PaperVelocity, AFartherLandmarkFallsShortUntilItsTrustIsGone) {
  const int most = kRanks.initial_normal() - kRanks.critical + 2;
  const std::vector<int> lived = lives(0.4);
  ASSERT_GT(lived.size(), 10u);
  for (const int frames : lived) EXPECT_LE(frames, most);
  EXPECT_TRUE(lives(1.0).empty());  // one edge all the way
}

/// A nearer one outgrows its radius: mu^ settles at |V_v - V~| t_f, the residual itself.
TEST(PaperVelocity, ANearerLandmarkOutgrowsItsRadiusNowAndThen) {
  const std::vector<int> lived = lives(2.0);
  ASSERT_FALSE(lived.empty());
  for (const int frames : lived) EXPECT_GT(frames, 3);
}

/// A new normal edge: V = V_v, beta from the focus, mu_0, and (Tr_c + Tr_s)/2.
TEST(NormalEdge, StartsAtTheVehiclesSpeedFromTheFocusWithMu0) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const EgoMotion motion = steady_motion(
        {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), 0.5}, {0, 0.1, 0}, 0.1);
    const MotionField field(vga(), motion, FieldParameters{});
    EdgeSteps experts;
    AllLayers layers;
    const Vec2 x(random.uniform(0, 639), random.uniform(0, 479));
    EXPECT_EQ(step(experts, layers, {x}, field)[0], Verdict::pending);
    ASSERT_EQ(layers.normal_edges.size(), 1u);
    const Edge& edge = layers.normal_edges[0];
    EXPECT_EQ(edge.location, x);
    EXPECT_DOUBLE_EQ(edge.speed, field.reference_speed(x));
    EXPECT_NEAR(angle_between(edge.angle, angle_of(x - *field.foe())), 0, 1e-9);
    EXPECT_DOUBLE_EQ(edge.mu, kLab.mu_0);
    EXPECT_EQ(edge.trust, kRanks.initial_normal());
  }
}

/// xi_1: the corner becomes another normal edge and no candidate, and the edge behind it loses
/// trust.
TEST(Xi, OneMakesAFurtherNormalEdgeAndNoCandidate) {
  const MotionField field = to_the_right();
  const Edge edge = edge_with_radius(4);
  AllLayers layers;
  layers.normal_edges = {edge};
  EdgeSteps experts;
  const Vec2 predicted = field.translated(edge.location, 1);
  step(experts, layers, {predicted + Vec2(8, 0)}, field);
  ASSERT_EQ(layers.normal_edges.size(), 2u);
  EXPECT_EQ(layers.normal_edges[0].trust, 3);
  EXPECT_EQ(layers.normal_edges[1].location, predicted + Vec2(8, 0));
  EXPECT_TRUE(layers.chains.empty());
}

/// xi_4 and xi_5: the corner goes to alpha.
TEST(Xi, FourAndFiveGoToAlpha) {
  const MotionField field = to_the_right();
  const Edge edge = edge_with_radius(20);
  const Vec2 predicted = field.translated(edge.location, 1);
  const Vec2 against = edge.location - Vec2(5, 0);  // inside mu: 12 px short of the prediction
  ASSERT_LT((against - predicted).norm(), edge.mu);
  // 9 degrees over the 400 px up to which the span widens are 63 px.
  for (const Vec2& x : {against, Vec2(predicted + Vec2(0, 80))}) {
    AllLayers layers;
    layers.normal_edges = {edge};
    EdgeSteps experts;
    step(experts, layers, {x}, field);
    ASSERT_EQ(layers.chains.size(), 1u);
    EXPECT_EQ(layers.chains[0].sightings[0], x);
    EXPECT_EQ(layers.normal_edges[0].trust, 3);
  }
}

/// Only an edge that lost its own corner has a layer to extend.
TEST(Xi, OneOfAnEdgeWithACornerOfItsOwnIsACandidate) {
  const MotionField field = to_the_right();
  const Edge edge = edge_with_radius(4);
  AllLayers layers;
  layers.normal_edges = {edge};
  EdgeSteps experts;
  const Vec2 predicted = field.translated(edge.location, 1);
  step(experts, layers, {predicted, predicted + Vec2(8, 0)}, field);
  ASSERT_EQ(layers.chains.size(), 1u);
  EXPECT_EQ(layers.chains[0].sightings[0], predicted + Vec2(8, 0));
}

/// With the focus far off, the span would widen to the whole image.
TEST(Xi, TheSpanWidensUpToHalfADiagonal) {
  const MotionField field = to_the_right();
  AllLayers layers;
  layers.normal_edges.resize(1);
  layers.normal_edges[0].location = {300, 240};
  layers.normal_edges[0].mu = 200;
  EdgeSteps experts;
  experts.predict(layers, field);
  const Edge& edge = layers.normal_edges[0];
  const double half_width = 400 * std::sin(kLab.delta_v) + kLab.corner_noise;
  for (const double side : {-1.0, 1.0}) {
    const auto at = [&](double aside) {
      return experts.expert.classify(edge, edge.predicted + Vec2(0, side * aside), field);
    };
    EXPECT_EQ(at(half_width - 1), Xi::two);
    EXPECT_EQ(at(half_width + 1), Xi::five);
  }
}

/// Two edges predicted on either side of one corner, on the line of the flow.
struct Competing : ::testing::Test {
  const MotionField field = to_the_right();
  /// Whether the edge predicted at `first`, relative to the corner, wins against `second`.
  bool first_wins(const Vec2& first, int first_trust, const Vec2& second, int second_trust) {
    const Vec2 corner(400, 240), back = field.translated(corner, 1) - corner;
    AllLayers layers;
    layers.normal_edges.resize(2);
    layers.normal_edges[0].location = corner + first - back;
    layers.normal_edges[1].location = corner + second - back;
    layers.normal_edges[0].trust = first_trust;
    layers.normal_edges[1].trust = second_trust;
    for (Edge& edge : layers.normal_edges) edge.mu = 20;
    EdgeSteps experts;
    step(experts, layers, {corner}, field);
    EXPECT_NE(layers.normal_edges[0].corner < 0, layers.normal_edges[1].corner < 0);
    return layers.normal_edges[0].corner >= 0;
  }
};

TEST_F(Competing, TheNearestEdgeGetsTheCornerUnlessAnotherIsTrustedEnoughMore) {
  EXPECT_TRUE(first_wins({0, 2}, 4, {0, -2.4}, 4));
  EXPECT_FALSE(first_wins({0, 2.4}, 4, {0, -2}, 4));
  // Two steps of trust are worth half a pixel.
  EXPECT_FALSE(first_wins({0, 2}, 3, {0, -2.4}, 5));
  EXPECT_TRUE(first_wins({0, 2}, 3, {0, -2.6}, 5));
}

TEST_F(Competing, AMatchThatRaisesTrustComesBeforeOneThatCostsIt) {
  // The first prediction overshoots by 3 px (xi_3), the second falls 4 px short (xi_2).
  EXPECT_FALSE(first_wins({3, 0}, 4, {-4, 0}, 4));
  EXPECT_TRUE(first_wins({3, 0}, 4, {-5, 0}, 4));
}

// ------------------------------------------------------------------------------------------- alpha

/// A camera that turns on the spot: every other motion is a rebel's.
MotionField turning(const Vector3d& w) {
  return {vga(), steady_motion(Vector3d::Zero(), w, 0.1), FieldParameters{}};
}
MotionField standing() {
  return turning(Vector3d::Zero());
}

TEST(RebelInitial, ValuesAreThoseOfTheThreeSightings) {
  Random random(3);
  for (int i = 0; i < 200; ++i) {
    const MotionField field = turning(random.vector(0.2));
    const Vec2 a(random.uniform(200, 440), random.uniform(150, 330));
    const double heading = random.uniform(-kPi, kPi), length = random.uniform(8, 25);
    // Image of a point that moves in this way in an image without rotation.
    const Vec2 b_of_1 = a + length * unit_vector(heading);
    const Vec2 b = field.rotated(b_of_1);
    const Vec2 a2 = field.rotated(field.rotated(a)), b2 = field.rotated(b);
    const double turn = random.uniform(-0.2, 0.2), stretch = random.uniform(0.85, 1.15);
    const Vec2 c = b2 + stretch * length * unit_vector(angle_of(b2 - a2) + turn);
    EdgeSteps experts;
    AllLayers layers;
    EXPECT_EQ(step(experts, layers, {a}, field)[0], Verdict::pending);
    EXPECT_EQ(step(experts, layers, {b}, field)[0], Verdict::pending);
    EXPECT_EQ(step(experts, layers, {c}, field)[0], Verdict::rebel);
    ASSERT_EQ(layers.rebel_edges.size(), 1u);
    const Edge& edge = layers.rebel_edges[0];
    EXPECT_TRUE(edge.origin.isApprox(a2, 1e-12));
    EXPECT_EQ(edge.location, c);
    EXPECT_TRUE(edge.rotated.isApprox(b2, 1e-12));
    EXPECT_NEAR(edge.speed, (c - b2).norm() / 0.1, 1e-9);
    EXPECT_NEAR(angle_between(edge.angle, angle_of(c - a2)), 0, 1e-12);
    EXPECT_NEAR(edge.mu, angle_between(angle_of(c - a2), angle_of(b2 - a2)), 1e-12);
    EXPECT_GT(edge.trust, kRanks.standard);
    EXPECT_TRUE(layers.chains.empty());  // the row is deleted after its success
  }
}

/// Whether a corner that moves by `first` and then by `second` becomes a rebel.
bool becomes_rebel(const Vec2& first, const Vec2& second) {
  EdgeSteps experts;
  AllLayers layers;
  const Vec2 a(320, 240);
  step(experts, layers, {a}, standing());
  step(experts, layers, {a + first}, standing());
  step(experts, layers, {a + first + second}, standing());
  return !layers.rebel_edges.empty();
}

TEST(Alpha, ABendBeyondMuROrAChangeOfSpeedEndsARow) {
  const double length = 40, limit = kLab.alpha_deviation;
  const auto bent = [&](double turn) { return Vec2(length * unit_vector(turn)); };
  EXPECT_TRUE(becomes_rebel({length, 0}, {length, 0}));
  // Two equal steps with a turn between them bend the line from first to last by half of
  // the turn.
  EXPECT_TRUE(becomes_rebel({length, 0}, bent(0.33)));
  // At this reach the bend of 20 degrees does not limit a row of two equal steps; the gate
  // does.
  EXPECT_FALSE(becomes_rebel({length, 0}, bent(2 * limit + 0.05)));
  EXPECT_FALSE(becomes_rebel({length, 0}, bent(-2 * limit - 0.05)));
  EXPECT_TRUE(becomes_rebel({length, 0}, {length * (1 + 0.9 * kLab.alpha_stretch), 0}));
  EXPECT_FALSE(becomes_rebel({length, 0}, {length * (1 + 1.1 * kLab.alpha_stretch), 0}));
  EXPECT_FALSE(becomes_rebel({length, 0}, {-length, 0}));
  EXPECT_FALSE(becomes_rebel({kLab.alpha_reach + 1, 0}, {kLab.alpha_reach + 1, 0}));
}

/// In the presets the gate of `alpha_stretch` is tighter; where it is wide, mu_r decides.
TEST(Alpha, TheBendOfTheLineIsAtMostMuR) {
  PaperParameters p;
  p.edge.alpha_stretch = 1;
  const auto found = [&](double bend) {
    EdgeSteps experts(p);
    AllLayers layers;
    const Vec2 a(320, 240), b = a + Vec2(30, 0), c = a + 55 * unit_vector(bend);
    for (const Vec2& x : {a, b, c}) step(experts, layers, {x}, standing());
    return !layers.rebel_edges.empty();
  };
  for (const double sign : {-1.0, 1.0}) {
    EXPECT_TRUE(found(sign * (p.edge.alpha_deviation - 0.01)));
    EXPECT_FALSE(found(sign * (p.edge.alpha_deviation + 0.01)));
  }
}

/// Number of rebels after rows of two sightings get the new corners.
std::size_t rebels_after(const std::vector<Chain>& chains, const std::vector<Vec2>& corners,
                         const MotionField& field) {
  EdgeSteps experts;
  AllLayers layers;
  layers.chains = chains;
  step(experts, layers, corners, field);
  return layers.rebel_edges.size();
}
Chain row(const Vec2& a, const Vec2& b) {
  return {.sightings = {a, b}, .count = 2};
}

TEST(Alpha, MotionOfAnyPlausibleStaticPointIsNoRebel) {
  const MotionField field = to_the_right();
  const double step_px = field.reference_speed({300, 240}) * 0.1;
  const Vec2 a(300, 240);
  const auto found = [&](const Vec2& motion) {
    return rebels_after({row(a, a + motion)}, {a + 2 * motion}, field);
  };
  for (double ratio = 0; ratio < field.max_ratio(); ratio += 0.25) {
    EXPECT_EQ(found({ratio * step_px, 0}), 0u) << ratio;
  }
  EXPECT_EQ(found({field.max_ratio() * step_px + 4, 0}), 1u);
  EXPECT_EQ(found({-4, 0}), 1u);
  EXPECT_EQ(found({step_px, 4}), 1u);
}

TEST(Alpha, ASightingThatRowsShareBecomesOneRebel) {
  const Vec2 b(320, 240);
  EXPECT_EQ(rebels_after({row(b - Vec2(20, 3), b), row(b - Vec2(20, -3), b)},
                         {b + Vec2(20, 3), b + Vec2(20, -3)}, standing()),
            1u);
}

TEST(Alpha, ASightingBranchesIntoTheNearestOnly) {
  EdgeSteps experts;
  AllLayers layers;
  const Vec2 a(320, 240);
  std::vector<Vec2> candidates;
  for (int i = 0; i < 7; ++i) candidates.push_back(a + (5.0 + 3 * i) * unit_vector(i));
  step(experts, layers, {a}, standing());
  step(experts, layers, candidates, standing());
  std::vector<Vec2> seconds;
  for (const Chain& chain : layers.chains) {
    if (chain.count == 2) seconds.push_back(chain.sightings[1]);
  }
  ASSERT_EQ(seconds.size(), static_cast<std::size_t>(kLab.alpha_branches));
  for (int i = 0; i < kLab.alpha_branches; ++i) EXPECT_EQ(seconds[i], candidates[i]);
}

TEST(Alpha, TwoFramesOfOneTimeMakeNoRebelAndKeepTheRows) {
  EdgeSteps experts;
  AllLayers layers;
  const Vec2 a(320, 240);
  layers.chains = {row(a, a + Vec2(20, 0))};
  const MotionField no_time(vga(), EgoMotion{}, FieldParameters{});
  step(experts, layers, {a + Vec2(40, 0)}, no_time);
  EXPECT_TRUE(layers.rebel_edges.empty());
  ASSERT_EQ(layers.chains.size(), 1u);
  EXPECT_EQ(layers.chains[0].sightings[1], a + Vec2(20, 0));
}

TEST(Alpha, ARowBranchesIntoEveryCornerNearAndTheRightOneBecomesTheRebel) {
  EdgeSteps experts;
  AllLayers layers;
  const Vec2 a(320, 240);
  const std::vector<Vec2> candidates = {a + Vec2(0, 12), a + Vec2(15, 0), a + Vec2(-20, -20)};
  step(experts, layers, {a}, standing());
  step(experts, layers, candidates, standing());
  std::set<double> seconds;
  for (const Chain& chain : layers.chains) {
    if (chain.count != 2) continue;
    EXPECT_EQ(chain.sightings[0], a);
    seconds.insert(chain.sightings[1].x());
  }
  EXPECT_EQ(seconds, (std::set<double>{300, 320, 335}));
  step(experts, layers, {candidates[1] + Vec2(15, 1)}, standing());
  ASSERT_EQ(layers.rebel_edges.size(), 1u);
  EXPECT_NEAR(layers.rebel_edges[0].angle, std::atan2(1, 30), 1e-12);
  // Rows without a third corner are deleted.
  for (const Chain& chain : layers.chains) EXPECT_EQ(chain.count, 1);
}

TEST(Alpha, ACornerBecomesOneRebelHoweverManyRowsEndAtIt) {
  EdgeSteps experts;
  AllLayers layers;
  const Vec2 a(320, 240);
  step(experts, layers, {a, a + Vec2(0, 6), a + Vec2(0, 12)}, standing());
  step(experts, layers, {a + Vec2(20, 0), a + Vec2(20, 6), a + Vec2(20, 12)}, standing());
  step(experts, layers, {a + Vec2(40, 0), a + Vec2(40, 6), a + Vec2(40, 12)}, standing());
  EXPECT_EQ(layers.rebel_edges.size(), 3u);
  std::set<int> corners;
  for (const Edge& edge : layers.rebel_edges) corners.insert(edge.corner);
  EXPECT_EQ(corners.size(), 3u);
}

// ------------------------------------------------------------------------------------------ rebels

struct RebelEstimates : ::testing::Test {
  struct Case {
    Edge edge;
    MotionField field;
    Vec2 rotated, origin, along, predicted;
  };
  Case any() {
    Edge edge;
    edge.rebel = true;
    edge.location = {random.uniform(200, 440), random.uniform(150, 330)};
    edge.origin = edge.location - random.uniform(20, 60) * unit_vector(random.uniform(-kPi, kPi));
    edge.angle = angle_of(edge.location - edge.origin);
    edge.speed = random.uniform(100, 250);
    edge.mu = random.uniform(0, 0.2);
    edge.trust = kRanks.critical + static_cast<int>(random.uniform(0, 3.999));
    const MotionField field(
        vga(), steady_motion({0, 0, random.uniform(-0.5, 0.5)}, random.vector(0.2), 0.1),
        FieldParameters{});
    Case c{edge, field, field.rotated(edge.location), field.rotated(edge.origin), {}, {}};
    c.along = (c.rotated - c.origin).normalized();
    c.predicted = c.rotated + edge.speed * 0.1 * c.along;
    return c;
  }
  Edge after(const Case& c, const Vec2& corner, Verdict expected) {
    AllLayers layers;
    layers.rebel_edges = {c.edge};
    EdgeSteps experts;
    EXPECT_EQ(step(experts, layers, {corner}, c.field)[0], expected);
    return layers.rebel_edges.empty() ? Edge{} : layers.rebel_edges[0];
  }
  Random random{4};
};

TEST_F(RebelEstimates, FollowTheFormulasWithTheirOwnSpeedAndOrigin) {
  for (int i = 0; i < 200; ++i) {
    const Case c = any();
    const double ahead = random.uniform(-2, 2), aside = random.uniform(-2, 2);
    const Vec2 corner = c.predicted + ahead * c.along + aside * Vec2(-c.along.y(), c.along.x());
    const Edge edge = after(c, corner, Verdict::rebel);
    const double w = c.edge.trust - kRanks.critical;
    EXPECT_TRUE(edge.location.isApprox(Vec2((w * c.predicted + corner) / (w + 1)), 1e-9));
    EXPECT_NEAR(edge.speed, std::abs(c.edge.speed + ahead / 0.1), 1e-6);
    // mu^_r = |beta~ - beta^(k-1)|, beta~ from the corner to the origin.
    EXPECT_NEAR(edge.mu, angle_between(angle_of(corner - c.origin), angle_of(c.along)), 1e-9);
    EXPECT_NEAR(angle_between(edge.angle, angle_of(edge.location - c.origin)), 0, 1e-9);
    EXPECT_TRUE(edge.origin.isApprox(c.origin, 1e-12));
    EXPECT_EQ(edge.trust, std::min(c.edge.trust + 1, kRanks.maximum));
  }
}

/// zeta_r: near the prediction, and inside the span and the deviation about the origin.
TEST_F(RebelEstimates, CornersOutOfReachOrOutOfTheirSpanAreNotTheirs) {
  for (int i = 0; i < 200; ++i) {
    Case c = any();
    c.edge.mu = 0;
    c.edge.trust = kRanks.standard;
    const double step_px = c.edge.speed * 0.1, reach = kLab.rebel_reach * step_px;
    const Vec2 across(-c.along.y(), c.along.x());
    EXPECT_EQ(
        after(c, c.predicted + (std::max(3.0, reach) + 0.5) * c.along, Verdict::pending).trust,
        c.edge.trust - 1);
    const double from_origin = (c.predicted - c.origin).norm();
    const double half_width = std::max(3.0, from_origin * std::tan(kLab.delta_v));
    if (half_width + 0.5 < reach) {
      EXPECT_EQ(after(c, c.predicted + (half_width + 0.5) * across, Verdict::pending).trust,
                c.edge.trust - 1);
    }
    // A rebel that deviated in the last frame is searched for that much farther aside.
    c.edge.mu = 0.2;
    const double wider = from_origin * std::tan(kLab.delta_v + c.edge.mu);
    if (half_width + 1 < std::min(reach, wider)) {
      after(c, c.predicted + (half_width + 0.5) * across, Verdict::rebel);
    }
  }
}

}  // namespace
}  // namespace lcs
