/// A turn that no gyro saw: found from the corners of what stands still, and left where they do not
/// tell it.
#include "filter/ego_motion/unseen_turn.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "filter/filter.h"
#include "filter/kinematics/rotation.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::project;
using testing::Random;
using testing::Scene;
using testing::steady_motion;
using testing::vga;
using testing::World;

constexpr double kSigma_rad = 0.03;
constexpr double kPixel_rad = 1 / 415.7;

/// A frame of a static world, the edges that the frame before left of it, and what is told of the
/// motion between the two.
struct Blind {
  explicit Blind(std::uint64_t seed) : random(seed) {
    for (int i = 0; i < 200; ++i) {
      world.add({random.uniform(0, 639), random.uniform(0, 479)}, random.uniform(1.5, 10));
    }
    motion = steady_motion({0.05, 0.02, 0.5}, {0.02, -0.3, 0.03}, 0.1);
    for (const World::Point& point : world.points) {
      Edge edge;
      edge.location = project(vga(), point.x_C);
      edge.depth_ratio = FieldParameters{}.reference_depth_m / point.x_C.z();
      edge.trust = trust.maximum;
      edges.push_back(edge);
    }
    world.advance(motion);
  }

  /// Told with a rotation that lacks this one.
  EgoMotion told(const Vector3d& unseen_rad) const {
    EgoMotion told = motion;
    told.R_cur_prev = exponential(-unseen_rad) * motion.R_cur_prev;
    told.unseen_turn_rad = kSigma_rad;
    return told;
  }

  /// Of whole pixels, as FAST's, but for every `missing`th.
  std::vector<Vec2> corners(int missing = 0) const {
    std::vector<Vec2> corners;
    for (std::size_t i = 0; i < world.points.size(); ++i) {
      const auto px = world.image(world.points[i]);
      if (px && (missing == 0 || i % missing != 0)) corners.push_back(px->array().round());
    }
    return corners;
  }

  EgoMotion seen(const EgoMotion& told, const std::vector<Vec2>& corners) const {
    return UnseenTurn(vga(), FieldParameters{}, trust).seen(told, edges, corners);
  }

  double error_px(const EgoMotion& seen) const {
    return logarithm(seen.R_cur_prev * motion.R_cur_prev.transpose()).norm() / kPixel_rad;
  }

  Random random;
  TrustRanks trust = CircleParameters{}.trust;
  World world;
  EgoMotion motion;
  std::vector<Edge> edges;
};

TEST(UnseenTurn, IsSeenByTheCornersToAFifthOfAPixel) {
  // 200 corners that err by 0.41 px each: 0.03 px about each axis, and a roll, which the corners
  // tell half as well; mismatches at the gates add as much again.
  Random random(1);
  for (int trial = 0; trial < 30; ++trial) {
    const Blind blind(trial + 1);
    const Vector3d unseen(random.uniform(-0.01, 0.01), random.uniform(-0.08, 0.08),
                          random.uniform(-0.01, 0.01));
    const EgoMotion found = blind.seen(blind.told(unseen), blind.corners());
    EXPECT_LT(blind.error_px(found), 0.2) << unseen.transpose();
    const Vector3d rate = -logarithm(found.R_cur_prev) / found.dt_s;
    EXPECT_LT((found.w_C_radps - rate).norm(), 1e-12);
    EXPECT_EQ(found.v_C_mps, blind.motion.v_C_mps);
  }
}

TEST(UnseenTurn, IsSeenBesideAMoverAndClutterAndWithAThirdOfTheCornersGone) {
  for (int trial = 0; trial < 30; ++trial) {
    Blind blind(trial + 101);
    std::vector<Vec2> corners = blind.corners(3);
    // A tenth of the edges was taken for static and moves on by 12 px; 100 corners are new.
    for (std::size_t i = 0; i < corners.size(); i += 10) corners[i] += Vec2(-12, 3);
    for (int i = 0; i < 100; ++i) {
      corners.emplace_back(blind.random.uniform(0, 639), blind.random.uniform(0, 479));
    }
    const EgoMotion found = blind.seen(blind.told({0.003, 0.04, -0.002}), corners);
    EXPECT_LT(blind.error_px(found), 0.4) << trial;
  }
}

TEST(UnseenTurn, IsAsToldWhereNoCornersAgree) {
  for (int trial = 0; trial < 30; ++trial) {
    Blind blind(trial + 201);
    std::vector<Vec2> corners;
    for (int i = 0; i < 200; ++i) {
      corners.emplace_back(blind.random.uniform(0, 639), blind.random.uniform(0, 479));
    }
    const EgoMotion told = blind.told({0, 0.04, 0});
    EXPECT_EQ(blind.seen(told, corners).R_cur_prev, told.R_cur_prev) << trial;
  }
}

TEST(UnseenTurn, IsAsToldWhereTooFewEdgesAreEstablished) {
  Blind blind(1);
  const EgoMotion told = blind.told({0, 0.04, 0});
  const std::vector<Vec2> corners = blind.corners();
  EXPECT_EQ(blind.seen(told, {}).R_cur_prev, told.R_cur_prev);
  for (std::size_t i = 7; i < blind.edges.size(); ++i) blind.edges[i].trust = blind.trust.standard;
  EXPECT_EQ(blind.seen(told, corners).R_cur_prev, told.R_cur_prev);
  blind.edges.clear();
  EXPECT_EQ(blind.seen(told, corners).R_cur_prev, told.R_cur_prev);
}

/// Rebels among 150 static corners, in the worst of four frames in which the turn is not told.
int most_false_rebels(Parameters parameters, double unseen_turn_rad) {
  Scene scene(5);
  Filter filter(scene.world.camera, parameters);
  int most = 0;
  for (int k = 0; k < 16; ++k) {
    const bool blind = k >= 12;
    // 5 px a frame at the centre of the picture.
    const EgoMotion motion =
        blind ? steady_motion(scene.motion.v_C_mps, scene.motion.w_C_radps + Vector3d(0, 0.12, 0),
                              scene.motion.dt_s)
              : scene.motion;
    if (k > 0) scene.world.advance(motion);
    EgoMotion told = k == 0 ? EgoMotion{} : scene.motion;
    if (blind) told.unseen_turn_rad = unseen_turn_rad;
    std::vector<Eigen::Vector2f> corners;
    std::vector<bool> is_static;
    for (const World::Point& point : scene.world.points) {
      const auto px = scene.world.image(point);
      if (!px) continue;
      corners.push_back(px->cast<float>());
      is_static.push_back(point.velocity_C.isZero());
    }
    const FrameResult& result = filter.step(corners, told);
    int rebels = 0;
    for (std::size_t i = 0; i < corners.size(); ++i) {
      rebels += is_static[i] && result.verdicts[i] == Verdict::rebel;
    }
    if (blind) most = std::max(most, rebels);
  }
  return most;
}

TEST(Filter, DoesNotCallTheWorldARebelWhileTheGyroIsNotHeard) {
  for (const bool ignore : {false, true}) {  // where psi is, the Line expert looks for the turn
    Parameters parameters = preset("default");
    parameters.line.ignore = ignore;
    EXPECT_LE(most_false_rebels(parameters, kSigma_rad), 5) << ignore;
    EXPECT_GT(most_false_rebels(parameters, 0), 25) << ignore;
    parameters.field.unseen_turn = false;
    EXPECT_GT(most_false_rebels(parameters, kSigma_rad), 25) << ignore;
  }
}

}  // namespace
}  // namespace lcs
