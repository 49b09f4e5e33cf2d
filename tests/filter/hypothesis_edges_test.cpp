/// Edges with two hypotheses: the whole rule.
#include <gtest/gtest.h>

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "filter/edges/corner_noise.h"
#include "filter/ego_motion/estimator.h"
#include "filter/filter.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/types/diagnostics.h"
#include "filter/types/frame_result.h"
#include "filter/types/layers.h"
#include "filter/types/reason.h"
#include "filter/types/signature.h"
#include "tests/filter/hypotheses_support.h"
#include "tests/filter/same_result.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using testing::expect_same;
using testing::kDt_s;
using testing::kUsual;
using testing::Random;
using testing::record;
using testing::Scene;
using testing::sparse_world;
using testing::steady_motion;
using testing::vga;
using testing::World;

using Corners = std::vector<Vector2f>;

/// Whole pixels, as FAST returns them.
Corners rounded(Corners corners) {
  for (Vector2f& x : corners) x = x.array().round();
  return corners;
}

std::ptrdiff_t rebels(const FrameResult& result, std::size_t first, std::size_t last) {
  const auto begin = result.verdicts.begin();
  return std::count(begin + static_cast<std::ptrdiff_t>(first),
                    begin + static_cast<std::ptrdiff_t>(last), Verdict::rebel);
}
std::ptrdiff_t rebels(const FrameResult& result) {
  return rebels(result, 0, result.verdicts.size());
}

TEST(HypothesisEdges, AStaticWorldOfWholePixelsIsSilent) {
  for (const double spacing : {60, 30}) {
    for (const Vector3d& v : {Vector3d(0, 0, 0.5), Vector3d(0.3, 0, 0), Vector3d(0, 0, -0.4)}) {
      World world = sparse_world(5, spacing);
      const EgoMotion motion = steady_motion(v, {0.01, 0.05, -0.02}, kDt_s);
      Filter filter(world.camera);
      for (int k = 0; k < 25; ++k) {
        const FrameResult& result =
            filter.step(rounded(world.corners()), k == 0 ? EgoMotion{} : motion);
        EXPECT_EQ(rebels(result), 0)
            << "v " << v.transpose() << ", every " << spacing << " px, frame " << k;
        world.advance(motion);
      }
    }
  }
}

/// Posts before a wall: points of both, and the crossings of the posts' outlines with the wall's
/// upper edge, with signatures.
struct Seen {
  Corners corners;
  std::vector<Signature> signatures;
};
/// \param ahead_m way that the camera has gone.
Seen posts_before_wall(const Intrinsics& camera, double ahead_m, std::uint64_t frame) {
  Seen seen;
  std::size_t point = 0;
  const auto add = [&](double x_m, double y_m, double near_m, double far_m) {
    const double near = near_m - ahead_m, far = far_m - ahead_m;
    const Vec2 px(camera.centre_px.x() + camera.focal_px * x_m / near,
                  camera.centre_px.y() + camera.focal_px * y_m / far);
    const bool is_seen = near > 0.5 && px.x() > 0 && px.y() > 0 && px.x() < 639 && px.y() < 479;
    ++point;
    if (!is_seen) return;
    seen.corners.push_back(px.cast<float>());
    seen.signatures.push_back(testing::signature_of(point, frame));
  };
  for (const double post_m : {-1.8, 1.5, 2.3}) {
    for (const double side_m : {post_m - 0.15, post_m + 0.15}) {
      add(side_m, 0.9, 9.5, 9.5);
      add(side_m, -1.9, 9.5, 9.5);
      add(side_m, -2.0, 9.5, 16);  // a crossing
    }
  }
  for (const double x_m : {-4.0, -1.0, 3.0}) add(x_m, -2.0, 16, 16);
  return seen;
}

/// A crossing may slide farther than (34) expects, so that few are left.
TEST(HypothesisEdges, FewCrossingsOfNearOutlinesWithAFarEdgeAreRebels) {
  const EgoMotion motion = steady_motion({0, 0, 1.5}, Vector3d::Zero(), 0.05);
  const auto count = [&](const Parameters& parameters) {
    std::ptrdiff_t sum = 0;
    Filter filter(vga(), parameters);
    for (std::uint64_t k = 0; k < 60; ++k) {
      const Seen seen = posts_before_wall(vga(), 0.075 * static_cast<double>(k), k);
      sum += rebels(
          filter.step(rounded(seen.corners), seen.signatures, k == 0 ? EgoMotion{} : motion));
    }
    return sum;
  };
  Parameters without;
  without.edge.crossings = 0;
  EXPECT_GT(count(without), 20) << "the crossings of this test are none";
  EXPECT_LT(5 * count(Parameters{}), count(without));
}

/// The depth that it seemed to have while it moved must not keep it a rebel.
TEST(HypothesisEdges, AMoverThatStopsIsStaticSoonAfterwards) {
  for (const double speed_mps : {-0.6, 0.8}) {
    World world = sparse_world(7);
    const std::size_t first = world.points.size();
    for (int i = 0; i < 16; ++i) world.add({300 + 12 * (i % 4), 200 + 12 * (i / 4)}, 4);
    const EgoMotion motion = steady_motion({0.2, 0, 0.5}, Vector3d::Zero(), kDt_s);
    Filter filter(world.camera);
    for (std::size_t k = 0; k < 26; ++k) {
      for (std::size_t i = first; i < world.points.size(); ++i) {
        world.points[i].velocity_C = k < 12 ? Vector3d(speed_mps, 0, 0) : Vector3d::Zero();
      }
      const FrameResult& result =
          filter.step(rounded(world.corners()), world.signatures(k), k == 0 ? EgoMotion{} : motion);
      const std::size_t last = result.verdicts.size();
      if (k == 10) {
        EXPECT_GT(rebels(result, last - 16, last), 12) << speed_mps;
      }
      if (k > 22) {
        EXPECT_EQ(rebels(result, last - 16, last), 0) << speed_mps << ", frame " << k;
      }
      world.advance(motion);
    }
  }
}

/// The mean of normalised squared misses is 2, one for each axis. A corner of 1 px has 16 by the
/// noise of the scene, and comes to 3: that noise still counts as 9 of some 25 sightings.
TEST(CornerNoise, MissesAreAsLargeAsExpectedAtAnyNoise) {
  for (const double sigma_px : {0.35, 0.6, 1.0}) {
    Random random(3);
    double sum = 0;
    int count = 0;
    for (int corner = 0; corner < 200; ++corner) {
      CornerNoise noise;
      for (int k = 0; k < 40; ++k) {
        double miss2 = 0;
        for (int axis = 0; axis < 2; ++axis) {
          double normal = 0;  // of 12 uniform numbers
          for (int i = 0; i < 12; ++i) normal += random.uniform(-0.5, 0.5);
          miss2 += sigma_px * sigma_px * normal * normal;
        }
        const double variance = noise.variance_px2(0.35 * 0.35, 9);
        if (k >= 20) {
          sum += miss2 / variance;
          ++count;
        }
        noise.fade(0.96);
        noise.add(miss2 / 2, 1);
      }
    }
    EXPECT_GT(sum / count, 1.8) << sigma_px;
    EXPECT_LT(sum / count, 3.2) << sigma_px;
  }
}

/// No track has a motion yet; a turn of 4 mrad is 1.7 px, more than most of the first steps.
TEST(HypothesisEdges, AFirstTurnThatIsToldWrongIsSeenByTheCorners) {
  for (const Vector3d& turn_rad :
       {Vector3d(4e-3, 0, 0), Vector3d(0, -4e-3, 0), Vector3d(2e-3, 2e-3, 4e-3)}) {
    World world = sparse_world(5, 30);
    const EgoMotion motion = steady_motion({0, 0, 0.5}, {0.01, 0.05, -0.02}, kDt_s);
    const EgoMotion wrong =
        steady_motion(motion.v_C_mps, motion.w_C_radps + turn_rad / kDt_s, kDt_s);
    Filter filter(world.camera);
    for (std::size_t k = 0; k < 6; ++k) {
      const EgoMotion told = k == 0 ? EgoMotion{} : k == 1 ? wrong : motion;
      const FrameResult& result = filter.step(rounded(world.corners()), world.signatures(k), told);
      EXPECT_EQ(rebels(result), 0) << turn_rad.transpose() << ", frame " << k;
      world.advance(motion);
    }
  }
}

/// As when poses jump, or freeze for some frames: the motion before goes on.
TEST(HypothesisEdges, GoOnWhereTheToldMotionIsNotTheCameras) {
  const EgoMotion motion = steady_motion({0.6, 0, 0.5}, {0.01, 0.05, -0.02}, kDt_s);
  struct Wrong {
    const char* what;
    EgoMotion told;
    int frames;
  };
  for (const auto& [what, wrong, frames] :
       {Wrong{"a turn", steady_motion(motion.v_C_mps, {0, 1, 0}, kDt_s), 3},
        Wrong{"a step aside", steady_motion({8, 0, 0.5}, motion.w_C_radps, kDt_s), 1},
        Wrong{"a step upwards", steady_motion({0.6, -8, 0.5}, motion.w_C_radps, kDt_s), 3},
        Wrong{"none at all", steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s), 3}}) {
    World world = sparse_world(5, 30);
    Filter filter(world.camera);
    for (int k = 0; k < 16; ++k) {
      const bool is_wrong = k >= 8 && k < 8 + frames;
      const FrameResult& result =
          filter.step(rounded(world.corners()), world.signatures(static_cast<std::uint64_t>(k)),
                      k == 0     ? EgoMotion{}
                      : is_wrong ? wrong
                                 : motion);
      EXPECT_EQ(rebels(result), 0) << what << ", frame " << k;
      const auto edges = result.layers.normal_edges.size();
      EXPECT_EQ(edges > 200, k > 0) << what << ", frame " << k << ": " << edges;
      world.advance(motion);
    }
    EXPECT_EQ(filter.diagnostics().count(Fault::motion_contradicted), frames) << what;
    EXPECT_EQ(filter.diagnostics().total(), frames) << what;
  }
}

/// One position is wrong, so that two motions are: there and back.
TEST(HypothesisEdges, GoOnWhereOnePositionIsWrong) {
  const EgoMotion motion = steady_motion({0, 0, 0.5}, {0.01, 0.05, -0.02}, kDt_s);
  for (const Vector3d& off_m : {Vector3d(1, 0, 0), Vector3d(0, 0, 1), Vector3d(0, 0.5, -1)}) {
    World world = sparse_world(5, 30);
    Filter filter(world.camera);
    for (int k = 0; k < 16; ++k) {
      EgoMotion told = k == 0 ? EgoMotion{} : motion;
      if (k == 8) told.v_C_mps += off_m / kDt_s;
      if (k == 9) told.v_C_mps -= off_m / kDt_s;
      const FrameResult& result = filter.step(
          rounded(world.corners()), world.signatures(static_cast<std::uint64_t>(k)), told);
      EXPECT_EQ(rebels(result), 0) << off_m.transpose() << ", frame " << k;
      world.advance(motion);
    }
    EXPECT_EQ(filter.diagnostics().count(Fault::motion_contradicted), 2) << off_m.transpose();
  }
}

/// The depths that it gave are dropped once the next motion contradicts them.
TEST(HypothesisEdges, BeginAnewAfterAWrongFirstMotion) {
  const EgoMotion motion = steady_motion({0, 0, 0.5}, {0.01, 0.05, -0.02}, kDt_s);
  for (const Vector3d& off_m : {Vector3d(3, 0, 0), Vector3d(0, 0, 2)}) {
    World world = sparse_world(5, 30);
    Filter filter(world.camera);
    for (int k = 0; k < 12; ++k) {
      EgoMotion told = k == 0 ? EgoMotion{} : motion;
      if (k == 1) told.v_C_mps += off_m / kDt_s;
      const FrameResult& result = filter.step(
          rounded(world.corners()), world.signatures(static_cast<std::uint64_t>(k)), told);
      EXPECT_TRUE(k <= 5 || rebels(result) < 5) << off_m.transpose() << ", frame " << k;
      world.advance(motion);
    }
    EXPECT_GE(filter.diagnostics().count(Fault::motion_contradicted), 1) << off_m.transpose();
  }
}

/// The told velocity drifts off too slowly for a contradiction, until nearly all corners are
/// rebels. None is then left to correct the motion, so that all tracks are dropped.
TEST(HypothesisEdges, BeginAnewOnceNearlyAllCornersWouldMove) {
  const EgoMotion motion = steady_motion({0.6, 0, 0.5}, {0.01, 0.05, -0.02}, kDt_s);
  World world = sparse_world(5, 30);
  Filter filter(world.camera);
  double most = 0;
  for (std::size_t k = 0; k < 30; ++k) {
    EgoMotion told = k == 0 ? EgoMotion{} : motion;
    if (k > 6) told.v_C_mps.x() += 0.02 * std::min<double>(static_cast<double>(k) - 6, 12);
    const FrameResult& result = filter.step(rounded(world.corners()), world.signatures(k), told);
    const double share =
        static_cast<double>(rebels(result)) / static_cast<double>(result.verdicts.size());
    EXPECT_LT(share, 0.85) << k;
    EXPECT_TRUE(k < 25 || share == 0) << k << ": " << share;
    most = std::max(most, share);
    world.advance(motion);
  }
  EXPECT_GT(most, 0.6) << "the told velocity of this test is near enough to the camera's";
  EXPECT_EQ(filter.diagnostics().count(Fault::motion_contradicted), 1);
}

/// The object was parked until then.
TEST(HypothesisEdges, ObjectFillingHalfThePictureIsSeenToDriveOff) {
  World world = sparse_world(5, 30);
  const EgoMotion motion = steady_motion({0, 0, 0.5}, {0, 0.05, 0}, kDt_s);
  Filter filter(world.camera);
  for (std::size_t k = 0; k < 12; ++k) {
    if (k == 6) {
      for (World::Point& point : world.points) {
        if (point.x_C.x() > 0) point.velocity_C = {0.3, -0.6, 0};
      }
    }
    const FrameResult& result =
        filter.step(rounded(world.corners()), world.signatures(k), k == 0 ? EgoMotion{} : motion);
    if (k > 8) {
      EXPECT_GT(rebels(result), 0.4 * static_cast<double>(result.verdicts.size())) << k;
    }
    world.advance(motion);
  }
  EXPECT_EQ(filter.diagnostics().total(), 0);
}

/// As on a pole in the wind: each frame turns by up to 10 mrad, 4 px, undetected by any gyro.
TEST(HypothesisEdges, AStandingCameraMayShake) {
  const World still = sparse_world(5, 30);
  EgoMotion told = steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s);
  told.unseen_turn_rad = unseen_turn_rad(kDt_s);
  Random random(1);
  Filter filter(still.camera);
  for (std::size_t k = 0; k < 40; ++k) {
    World shaken = still;
    shaken.advance(steady_motion(Vector3d::Zero(), random.vector(0.01) / kDt_s, kDt_s));
    const FrameResult& result =
        filter.step(rounded(shaken.corners()), shaken.signatures(k), k == 0 ? EgoMotion{} : told);
    if (k >= 10) {
      EXPECT_LE(rebels(result), 2) << "frame " << k;
    }
  }
}

TEST(HypothesisEdges, CornersThatJitterBeforeAStandingCameraStand) {
  for (const double spacing : {60, 20}) {
    const World world = sparse_world(8, spacing);
    const EgoMotion motion = steady_motion(Vector3d::Zero(), Vector3d::Zero(), kDt_s);
    Random random(1);
    Filter filter(world.camera);
    for (int k = 0; k < 40; ++k) {
      Corners corners = world.corners();
      for (Vector2f& x : corners) x += random.vector(0.7).head<2>().cast<float>();
      const FrameResult& result = filter.step(rounded(corners), k == 0 ? EgoMotion{} : motion);
      EXPECT_EQ(rebels(result), 0) << "every " << spacing << " px, frame " << k;
    }
  }
}

/// As with another detector or camera: the filter first assumes a noise of 0.35 px.
TEST(HypothesisEdges, CornersOfAnyExactnessStandBeforeACameraThatDrives) {
  for (const double half_px : {0.0, 1.0, 2.0, 4.0}) {
    World world = sparse_world(8, 40);
    const EgoMotion motion = steady_motion({0.1, 0, 0.3}, {0, 0.02, 0}, kDt_s);
    Random random(1);
    Filter filter(world.camera);
    std::size_t called = 0, seen = 0;
    for (std::size_t k = 0; k < 40; ++k) {
      Corners corners = world.corners();
      for (Vector2f& x : corners) x += random.vector(half_px).head<2>().cast<float>();
      const FrameResult& result =
          filter.step(corners, world.signatures(k), k == 0 ? EgoMotion{} : motion);
      world.advance(motion);
      if (k < 10) continue;
      called += static_cast<std::size_t>(rebels(result));
      seen += corners.size();
    }
    EXPECT_LE(100 * called, seen) << half_px << " px: " << called << " of " << seen;
  }
}

/// A background, and twelve close corners that cross it, before a moving or standing camera, with
/// and without signatures.
TEST(HypothesisEdges, APatchThatCrossesIsCalledAndTheBackgroundIsNot) {
  for (const double speed_mps : {0.0, 0.3}) {
    for (const bool looks : {false, true}) {
      World world = sparse_world(4, 40);
      for (int i = 0; i < 12; ++i) {
        world.add({500 + 11 * (i % 4) + 3 * (i / 4), 200 + 13 * (i / 4) + 2 * (i % 4)}, 3,
                  {-0.6, 0.05, 0});
      }
      const EgoMotion motion = steady_motion({0, 0, speed_mps}, {0, 0.02, 0}, kDt_s);
      Filter filter(world.camera);
      for (std::size_t k = 0; k < 12; ++k) {
        SCOPED_TRACE(::testing::Message()
                     << speed_mps << " m/s, frame " << k << (looks ? ", signatures" : ""));
        const Corners corners = rounded(world.corners());
        const EgoMotion told = k == 0 ? EgoMotion{} : motion;
        const FrameResult& result =
            looks ? filter.step(corners, world.signatures(k), told) : filter.step(corners, told);
        world.advance(motion);
        if (k < 3) continue;
        const std::size_t patch = corners.size() - 12;
        EXPECT_GE(rebels(result, patch, corners.size()), 10);
        // The patch does not occlude here: background inside it, or beside it for the first time,
        // may be taken for a part of it.
        EXPECT_LE(rebels(result, 0, patch), 2);
        for (std::size_t i = 0; i < patch; ++i) {
          const bool apart = std::all_of(corners.begin() + static_cast<std::ptrdiff_t>(patch),
                                         corners.end(), [&](const Vector2f& x) {
                                           return (x - corners[i]).norm() >
                                                  static_cast<float>(2 * kUsual.neighbour_reach_px);
                                         });
          EXPECT_FALSE(apart && result.verdicts[i] == Verdict::rebel) << corners[i].transpose();
        }
      }
    }
  }
}

TEST(HypothesisEdges, ACornerThatNobodyKnowsIsNotCalled) {
  // First frames, and later a new corner far from all others.
  Filter filter(vga());
  const EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), kDt_s);
  for (int k = 0; k < 3; ++k) {
    const Corners corners(1, Vector2f(100 + 200 * k, 200));
    const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    EXPECT_EQ(result.verdicts[0], Verdict::pending);
    EXPECT_EQ(result.reasons[0], Reason::first_sighting);
  }
}

TEST(HypothesisEdges, ACornerSeenOnceIsWhatTheNearestEdgeIs) {
  // Five cross by 8 px a frame before a standing camera, towards five static ones.
  const Corners moving = {{200, 200}, {209, 197}, {204, 211}, {219, 206}, {213, 217}};
  const Corners standing = {{269, 206}, {278, 199}, {284, 210}, {275, 217}, {290, 204}};
  const Vector2f by_a_mover(255, 206), by_what_stands(265, 206), halfway(260, 206),
      by_none(500, 400);
  const EgoMotion motion = steady_motion({0, 0, 0}, Vector3d::Zero(), kDt_s);
  for (const bool movers_first : {true, false}) {
    SCOPED_TRACE(movers_first ? "movers first" : "movers last");
    Filter filter(vga());
    FrameResult result;
    for (int k = 0; k < 5; ++k) {
      Corners movers = moving, corners = standing;
      for (Vector2f& x : movers) x.x() += static_cast<float>(8 * k);
      corners.insert(movers_first ? corners.begin() : corners.end(), movers.begin(), movers.end());
      if (k == 4) corners.insert(corners.end(), {by_a_mover, by_what_stands, halfway, by_none});
      result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    }
    const std::vector<Reason> reasons(result.reasons.end() - 4, result.reasons.end());
    EXPECT_EQ(reasons[0], Reason::inherited);
    EXPECT_EQ(reasons[1], Reason::first_sighting);
    EXPECT_EQ(reasons[2], Reason::inherited) << "of equally near ones the mover";
    EXPECT_EQ(reasons[3], Reason::first_sighting);
  }
}

TEST(HypothesisEdges, SayTheSameAgainAndWhateverTheOrderOfTheCorners) {
  Scene scene(2);
  Filter first(vga()), second(vga());
  Filter backward(vga());
  std::ptrdiff_t found = 0;
  for (std::size_t k = 0; k < 10; ++k) {
    const EgoMotion motion = k == 0 ? EgoMotion{} : scene.motion;
    Corners corners = scene.world.corners();
    std::vector<Signature> signatures = scene.world.signatures(k);
    const FrameResult& a = first.step(corners, signatures, motion);
    expect_same(a, second.step(corners, signatures, motion), k);
    std::reverse(corners.begin(), corners.end());
    std::reverse(signatures.begin(), signatures.end());
    FrameResult reversed = backward.step(corners, signatures, motion);
    std::reverse(reversed.verdicts.begin(), reversed.verdicts.end());
    std::reverse(reversed.reasons.begin(), reversed.reasons.end());
    expect_same(a, reversed, k);
    found += rebels(a);
    scene.world.advance(scene.motion);
  }
  EXPECT_GT(found, 20) << "or there is little to compare";
}

TEST(HypothesisEdges, ForgetAllWhereTheyStartAnew) {
  Scene scene(6);
  const auto frames = record(scene, 12);
  // A time step of zero, and an unknown time step.
  for (const double dt_s : {0.0, std::nan("")}) {
    Filter used(vga()), fresh(vga());
    std::ptrdiff_t found = 0;
    for (std::size_t k = 0; k < frames.size(); ++k) {
      EgoMotion motion = scene.motion;
      if (k == 0 || k == 6) motion = {};
      if (k == 6) motion.dt_s = dt_s;
      const FrameResult& result = used.step(frames[k], motion);
      found += rebels(result);
      if (k < 6) continue;
      const FrameResult& expected = fresh.step(frames[k], motion);
      ASSERT_EQ(result.verdicts, expected.verdicts) << "frame " << k;
      ASSERT_EQ(result.reasons, expected.reasons) << "frame " << k;
      ASSERT_EQ(result.layers.normal_edges.size(), expected.layers.normal_edges.size());
      for (std::size_t i = 0; i < expected.layers.normal_edges.size(); ++i)
        EXPECT_EQ(result.layers.normal_edges[i].speed, expected.layers.normal_edges[i].speed);
      if (std::isnan(dt_s)) expect_same(result, expected, k);  // circles and squares are equal, too
      if (k > 6) continue;
      EXPECT_TRUE(result.layers.normal_edges.empty() && result.layers.rebel_edges.empty());
      for (const Reason reason : result.reasons) EXPECT_EQ(reason, Reason::first_sighting);
      for (const Verdict verdict : result.verdicts) EXPECT_EQ(verdict, Verdict::pending);
    }
    EXPECT_GT(found, 0) << "or there is nothing to forget";
  }
}

}  // namespace
}  // namespace lcs
