/// Edges that share one motion, their circles, and the squares of these circles.
#include "filter/circles/motion_groups.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <limits>

#include "filter/circles/circle_expert.h"

#include "filter/kinematics/geometry.h"
#include "filter/squares/square_expert.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::ahead;
using testing::steady_motion;
using testing::vga;

/// A grid of normal edges at `depth_m`, with a depth error of about 1 %.
void add_patch(Layers& layers, const Vec2& low, const Vec2& high, double depth_m,
               double spacing_px = 10) {
  for (double y = low.y(); y <= high.y(); y += spacing_px) {
    for (double x = low.x(); x <= high.x(); x += spacing_px) {
      Edge edge;
      edge.location = {x, y};
      edge.origin = vga().centre_px;
      edge.depth_ratio = FieldParameters{}.reference_depth_m / depth_m;
      edge.depth_ratio_sigma = 0.01 * edge.depth_ratio;
      edge.id = layers.normal_edges.size() + 1;
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

/// The default circle and square experts, run frame after frame.
struct Experts {
  CircleExpert circles{vga(), {}, {}};
  SquareExpert squares{vga(), {}};

  void update(Layers& layers, const MotionField& field) {
    const BothKinds<Edge> edges{layers.normal_edges, layers.rebel_edges};
    const CircleExpert::Result& found = circles.step(edges, field);
    layers.squares = squares.step(edges, found, field);
    layers.normal_circles = found.circles.normal;
    layers.rebel_circles = found.circles.rebel;
    for (std::size_t i = 0; i < layers.normal_edges.size(); ++i) {
      layers.normal_edges[i].circle = found.of_edges.normal[i];
    }
    for (std::size_t i = 0; i < layers.rebel_edges.size(); ++i) {
      layers.rebel_edges[i].circle = found.of_edges.rebel[i];
    }
  }
};

std::vector<Square> squares_of(Layers layers, const MotionField& field = ahead()) {
  Experts().update(layers, field);
  return layers.squares;
}

/// Compared with the normal density of the measurements, level and slopes integrated out: the two
/// differ by a term that does not depend on the prior.
TEST(PlaneEvidence, IsTheDensityOfAllMeasurements) {
  testing::Random random(1);
  constexpr int kPoints = 7;
  Eigen::Matrix<double, kPoints, 3> X;
  Eigen::Matrix<double, kPoints, 2> Y;
  Eigen::Matrix<double, kPoints, 1> variances;
  PlaneSums sums;
  for (int i = 0; i < kPoints; ++i) {
    const Vec2 h(random.uniform(-0.5, 0.5), random.uniform(-0.5, 0.5));
    const Vec2 value(random.uniform(0, 2), random.uniform(-1, 1));
    const double sigma = random.uniform(0.1, 0.3);
    X.row(i) << 1, h.x(), h.y();
    Y.row(i) = value;
    variances(i) = sigma * sigma;
    sums += PlaneSums(h, value, sigma);
  }
  Eigen::RowVector3d middle = (variances.cwiseInverse().asDiagonal() * X).colwise().sum();
  middle /= middle(0);
  middle(0) = 0;
  const auto density = [&](const PlanePrior& prior) {
    const Eigen::Matrix<double, kPoints, 3> centred = X.rowwise() - middle;
    Eigen::Vector3d sigmas(prior.level_sigma, prior.slope_sigma, prior.slope_sigma);
    Eigen::Matrix<double, kPoints, kPoints> C =
        centred * sigmas.cwiseAbs2().asDiagonal() * centred.transpose();
    C.diagonal() += variances;
    const Eigen::Matrix<double, kPoints, 2> off = Y - X * prior.mean;
    return -0.5 * (off.transpose() * C.inverse() * off).trace() - std::log(C.determinant());
  };
  PlanePrior one{PlaneCoefficients::Zero(), 0.7, 0.4}, other{PlaneCoefficients::Zero(), 2, 3};
  other.mean << 1, -0.2, 0.3, 0.1, -0.5, 0.2;
  // Logarithms of single precision.
  EXPECT_NEAR(sums.evidence(one, 2) - sums.evidence(other, 2), density(one) - density(other), 1e-6);
}

/// Extent of a square whose corners span `half_size`, extended for the gaps of `count` corners.
Vec2 spanned(const Vec2& half_size, std::size_t count) {
  const auto n = static_cast<double>(count);
  return half_size * (n + 1) / (n - 1);
}

TEST(Groups, APatchAtOneDepthIsOneSquareRoundIt) {
  Layers layers;
  add_patch(layers, {100, 100}, {160, 140}, 3);
  const auto squares = squares_of(layers);
  ASSERT_EQ(squares.size(), 1u);
  EXPECT_TRUE(squares[0].location.isApprox(Vec2(130, 120)));
  EXPECT_TRUE(squares[0].half_size.isApprox(spanned({30, 20}, layers.normal_edges.size())));
  EXPECT_NEAR(squares[0].depth_ratio, 1.0, 1e-9);
}

TEST(Groups, PatchesThatTouchAtDifferentDepthsStayApart) {
  Layers layers;
  add_patch(layers, {100, 100}, {150, 150}, 3);
  add_patch(layers, {160, 100}, {210, 150}, 4.5);
  EXPECT_EQ(squares_of(layers).size(), 2u);
}

TEST(Groups, ADistanceParts) {
  Layers layers;
  add_patch(layers, {100, 100}, {150, 150}, 3);
  add_patch(layers, {250, 100}, {300, 150}, 3);
  EXPECT_EQ(squares_of(layers).size(), 2u);
}

/// A wall whose inverse depth is linear in the picture, from `near_m` at its left to `far_m`.
void add_wall(Layers& layers, double near_m, double far_m) {
  for (double x = 50; x <= 600; x += 10) {
    const double share = (x - 50) / 550;
    add_patch(layers, {x, 200}, {x, 240}, 1 / ((1 - share) / near_m + share / far_m));
  }
}

/// Each neighbour is near the next, but the ends differ greatly in depth: it is one object, too
/// large for a square.
TEST(Groups, AWallSeenAtASlantIsOneAndNoSquare) {
  Layers layers;
  add_wall(layers, 4, 9);
  Experts experts;
  experts.update(layers, ahead());
  ASSERT_EQ(layers.normal_circles.size(), 1u);
  EXPECT_EQ(layers.normal_circles[0].members, static_cast<int>(layers.normal_edges.size()));
  EXPECT_TRUE(layers.squares.empty());
}

TEST(Groups, PatchBeforeAWallIsASquareOfItsOwn) {
  Layers layers;
  add_wall(layers, 4, 9);
  add_patch(layers, {301, 150}, {341, 250}, 3);
  ASSERT_EQ(squares_of(layers).size(), 1u);
  EXPECT_TRUE(squares_of(layers)[0].location.isApprox(Vec2(321, 200)));
}

/// In any position in the picture, the known ground forms no circle, and an object on it forms
/// one.
TEST(Groups, TheGroundIsNoCircle) {
  const Ground ground{.height_m = 0.45};
  Layers layers;
  for (double y = 300; y <= 460; y += 10) {
    add_patch(layers, {100, y}, {500, y},
              vga().focal_px * ground.height_m / (y - vga().centre_px.y()));
  }
  Experts experts;
  experts.update(layers, ahead(ground));
  EXPECT_TRUE(layers.normal_circles.empty());

  // The object's foot is 2 m away, on row 333.
  add_patch(layers, {303, 203}, {353, 333}, 2);
  experts.update(layers, ahead(ground));
  ASSERT_EQ(layers.squares.size(), 1u);
  EXPECT_NEAR(layers.squares[0].location.x(), 328, 5);
  EXPECT_NEAR(layers.squares[0].location.y(), 265, 15);
}

TEST(Groups, RebelsOfOneVelocityAreOneAndNoneWithStaticOnes) {
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

TEST(Groups, RebelsInOneLineAreNoCircle) {
  Layers layers;
  add_rebels(layers, {100, 100}, {200, 100}, {80, 0});
  Experts().update(layers, ahead());
  EXPECT_TRUE(layers.rebel_circles.empty());
}

TEST(Groups, FewEdgesThinGroupsAndUnseenRebelsMakeNoSquare) {
  Layers layers;
  add_patch(layers, {100, 100}, {200, 100}, 3);  // on a line
  add_patch(layers, {300, 300}, {330, 310}, 3);
  layers.normal_edges.resize(layers.normal_edges.size() - 2);  // six, one fewer than needed
  add_rebels(layers, {300, 100}, {340, 140}, {80, 0});
  for (Edge& edge : layers.rebel_edges) edge.corner = -1;
  EXPECT_TRUE(squares_of(layers).empty());
  EXPECT_TRUE(squares_of({}).empty());
}

TEST(Groups, AnObjectIsOneBeforeADenseBackground) {
  Layers layers;
  add_patch(layers, {203, 203}, {283, 283}, 2, 20);
  const Vec2 half_size = spanned({40, 40}, layers.normal_edges.size());
  add_patch(layers, {180, 180}, {320, 320}, 4, 7);
  const auto is_object = [&](const Square& square) {
    return square.location.isApprox(Vec2(243, 243)) && square.half_size.isApprox(half_size);
  };
  EXPECT_EQ(std::ranges::count_if(squares_of(layers), is_object), 1);
}

/// Reach is larger upwards than sideways: head and feet are one body, two neighbours are two.
TEST(Groups, ReachFartherUpwardsThanAcross) {
  const double gap = 3.5 * CircleParameters{}.gap_m * vga().focal_px / 4;
  for (const double roll : {0.0, 0.5}) {  // upwards is away from the ground
    const Eigen::Rotation2Dd turned(roll);
    const auto count = [&](const Vec2& offset) {
      Layers layers;
      add_patch(layers, {-20, -20}, {20, 20}, 4);
      add_patch(layers, Vec2(-20, -20) + offset, Vec2(20, 20) + offset, 4);
      for (Edge& edge : layers.normal_edges) {
        edge.location = vga().centre_px + turned * edge.location;
      }
      const Vec2 up = turned * Vec2(0, -1);
      const Ground ground{.up_C = {up.x(), up.y(), 0}, .height_m = 2};
      return squares_of(layers, ahead(ground)).size();
    };
    EXPECT_EQ(count({40 + gap, 0}), 2u) << roll;
    EXPECT_EQ(count({0, -40 - gap}), 1u) << roll;
  }
}

/// The same distance in metres is more pixels at a small depth.
TEST(Groups, ReachFartherWhereTheyAreNear) {
  for (const double depth : {2.0, 8.0}) {
    Layers layers;
    add_patch(layers, {200, 100}, {380, 280}, depth, 60);
    EXPECT_EQ(squares_of(layers).size(), depth < 3 ? 1u : 0u) << depth;
  }
}

// 200 px wide; the width in metres depends on the depth.
TEST(Groups, PatchLargerThanAnObjectIsBackground) {
  const double limit_m = SquareParameters{}.max_size * vga().focal_px / 200;
  for (const double share : {0.9, 1.1}) {
    Layers layers;
    add_patch(layers, {200, 100}, {400, 200}, share * limit_m, 5);
    EXPECT_EQ(squares_of(layers).size(), share < 1 ? 1u : 0u);
  }
}

TEST(Groups, EdgesWithoutParallaxAreLeftOut) {
  Layers layers;
  add_patch(layers, {100, 100}, {150, 150}, 3);
  for (Edge& edge : layers.normal_edges) {
    edge.depth_ratio_sigma = std::numeric_limits<double>::infinity();
  }
  EXPECT_TRUE(squares_of(layers).empty());
}

/// A circle is recognised by its edges wherever they move, and so is its square.
TEST(Groups, GoOnWithTheMostOfTheirEdges) {
  Layers layers;
  add_patch(layers, {100, 100}, {140, 140}, 3);
  Experts experts;
  experts.update(layers, ahead());
  ASSERT_EQ(layers.squares.size(), 1u);
  const Id id = layers.squares[0].id;

  for (Edge& edge : layers.normal_edges) edge.location.x() += 300;
  layers.normal_edges.erase(layers.normal_edges.begin(), layers.normal_edges.begin() + 10);
  add_patch(layers, {100, 100}, {140, 140}, 3);  // other edges at the old place
  for (std::size_t i = 0; i < layers.normal_edges.size(); ++i) {
    layers.normal_edges[i].id = i + 11;
  }
  experts.update(layers, ahead());
  ASSERT_EQ(layers.squares.size(), 2u);
  EXPECT_EQ(layers.squares[0].id, id);
  EXPECT_GT(layers.squares[0].location.x(), 400);
  EXPECT_EQ(layers.squares[0].age, 1);
  EXPECT_EQ(layers.squares[1].age, 0);

  // Without edges the circle vanishes at once.
  layers.normal_edges.clear();
  experts.update(layers, ahead());
  EXPECT_TRUE(layers.squares.empty());
  EXPECT_TRUE(layers.normal_circles.empty());
}

}  // namespace
}  // namespace lcs
