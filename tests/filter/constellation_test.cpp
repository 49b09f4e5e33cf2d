/// What groups of corners tell that single ones cannot: situations that fooled each simpler rule.
#include "filter/constellation_edges.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string_view>

#include "filter/filter.h"
#include "filter/geometry.h"
#include "filter/nearest_map.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector2f;
using Eigen::Vector3d;
using testing::Random;
using testing::sparse_world;
using testing::steady_motion;
using testing::vga;
using testing::World;

using Corners = std::vector<Vector2f>;

std::ptrdiff_t rebels(const FrameResult& result) {
  return std::count(result.verdicts.begin(), result.verdicts.end(), Verdict::rebel);
}

Parameters with(const char* key, const char* value) {
  Parameters parameters = preset("default");
  set(parameters, key, value);
  return parameters;
}

TEST(Constellation, ARepeatingPatternOfFlickeringCornersComesToRest) {
  // Shifted by a period the pattern is its own past, and corners that are missing now and then make
  // some shift look better than rest by chance. Rebel edges that follow it speak for rest too
  // until they are sure, and once normal edges have a corner of now, their past is theirs.
  Random random(3);
  Filter filter(vga(), preset("default"));
  std::ptrdiff_t at_the_start = 0, later = 0;
  for (int k = 0; k < 40; ++k) {
    Corners corners;
    for (int row = 0; row < 12; ++row) {
      for (int column = 0; column < 24; ++column) {
        if (random.uniform(0, 1) < 0.15) continue;
        corners.emplace_back(120 + 12 * column, 100 + 14 * row);
      }
    }
    const EgoMotion motion = steady_motion(Vector3d::Zero(), Vector3d::Zero(), 0.1);
    (k < 15 ? at_the_start : later) += rebels(filter.step(corners, motion));
  }
  EXPECT_LT(at_the_start, 15 * 245 / 15);  // of 245 corners a frame
  EXPECT_EQ(later, 0);
}

TEST(Constellation, APatternThatATurnBringsIntoThePictureStandsStill) {
  // All round the camera, which turns by some of its columns a frame: what has just come into view
  // was not to be seen one baseline ago, or two, but what follows it had the look of its past.
  constexpr double kColumn_rad = 0.0217;
  for (const int columns : {2, 3, 4}) {
    World world;
    for (int column = 0; column < 2 * kPi / kColumn_rad; ++column) {
      const double heading = column * kColumn_rad;
      for (double y = -5; y < 5; y += 0.7)
        world.points.push_back({{20 * std::sin(heading), y, 20 * std::cos(heading)}});
    }
    const EgoMotion motion =
        steady_motion(Vector3d::Zero(), {0, -columns * kColumn_rad / 0.1, 0}, 0.1);
    Filter filter(world.camera, preset("default"));
    for (int k = 0; k < 30; ++k) {
      const auto found = rebels(filter.step(world.corners(), k == 0 ? EgoMotion{} : motion));
      EXPECT_EQ(found, 0) << columns << " columns, frame " << k;
      world.advance(motion);
    }
  }
}

/// Corners where an outline that moves along x crosses a fixed pattern behind it: they slide along
/// the outline, in line.
TEST(Constellation, CrossingsThatSlideAlongAnOutlineAreNoObject) {
  for (const char* width : {"0", "2"}) {
    Filter filter(vga(), with("constellation.support_width", width));
    std::ptrdiff_t found = 0;
    for (int k = 0; k < 12; ++k) {
      Corners corners;
      for (const float gap : {0.f, 9.f, 25.f, 36.f, 53.f, 60.f}) {
        const float x = 200 + gap + 4 * static_cast<float>(k);
        corners.push_back({x, 150 + 0.2f * x});  // the outline
      }
      corners.emplace_back(240 + 4 * k, 180);  // and one that goes along with it
      found += rebels(filter.step(corners, steady_motion(Vector3d::Zero(), Vector3d::Zero(), 0.1)));
    }
    if (width[0] == '0') {
      EXPECT_GT(found, 20) << "the outline is no trap: the test shows nothing";
    } else {
      EXPECT_EQ(found, 0);
    }
  }
}

/// A group that moves by 1.2 px from frame to frame at 30 Hz: less than a gate is wide.
int frames_until_found(const Parameters& parameters) {
  World world = sparse_world(4);
  Random random(5);
  for (int i = 0; i < 14; ++i) {
    world.add({random.uniform(250, 300), random.uniform(200, 250)}, 3, {0.26, 0, 0});
  }
  Filter filter(world.camera, parameters);
  const EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 1. / 30);
  for (int k = 0; k < 60; ++k) {
    const FrameResult& result = filter.step(world.corners(), k == 0 ? EgoMotion{} : motion);
    const auto found =
        std::count(result.verdicts.end() - 14, result.verdicts.end(), Verdict::rebel);
    if (found >= 10) return k;
    world.advance(motion);
  }
  return 60;
}

TEST(Constellation, ASlowMoverIsFoundAtAHighFrameRate) {
  // Over two baselines of 0.1 s it has moved by 7 px. Some frames more, for the young edges that
  // have followed it so far lie off the field by 2 px only then.
  EXPECT_LE(frames_until_found(preset("default")), 10);
  EXPECT_GE(frames_until_found(with("constellation.baseline", "0")), 30);
}

/// Rebels on its third sighting of a body of eight corners that changes its depth from frame to
/// frame, as it goes sideways before a camera that stands. Its motion needs four votes in five, so
/// that both earlier sightings have to be where they are sought.
std::ptrdiff_t found_of_a_body_that_goes(double depth_m, const Vector3d& velocity_mps) {
  World world;
  Random random(9);
  for (int i = 0; i < 8; ++i)
    world.add({random.uniform(270, 310), random.uniform(210, 250)}, depth_m, velocity_mps);
  Filter filter(vga(), with("constellation.vote_margin", "0.8"));
  std::ptrdiff_t found = 0;
  for (int k = 0; k < 3; ++k) {
    const EgoMotion motion = steady_motion(Vector3d::Zero(), Vector3d::Zero(), 0.1);
    found = rebels(filter.step(world.corners(), k == 0 ? EgoMotion{} : motion));
    world.advance(motion);
  }
  return found;
}

TEST(Constellation, AStepIsLongerTheNearerItWasAndNotOnlyByItsSize) {
  // With a constant velocity, steps of 20 to 40 px that shrink by a quarter or grow by nearly half
  // while the body shrinks by an eighth or grows by a quarter.
  EXPECT_EQ(found_of_a_body_that_goes(2.0, {2, 0, 3}), 8);
  EXPECT_EQ(found_of_a_body_that_goes(3.0, {1.6, 0, -4.7}), 8);
}

/// Why a corner got its verdict that appears at 30 Hz beside a body that moves by 4 px a frame, and
/// three frames ago there was another where the body's motion comes from.
Reason of_a_corner_beside_a_body(const Parameters& parameters) {
  Filter filter(vga(), parameters);
  constexpr int kLast = 14;
  const FrameResult* result = nullptr;
  for (int k = 0; k <= kLast; ++k) {
    Corners corners;
    for (int i = 0; i < 12; ++i) {
      const int x = 200 + 17 * (i % 4) + 7 * i % 5, y = 200 + 19 * (i / 4) + 5 * i % 7;
      corners.push_back(Eigen::Vector2i(x + 4 * k, y).cast<float>());
    }
    if (k == kLast - 3) corners.emplace_back(340, 225);
    if (k == kLast) corners.emplace_back(352, 225);
    const EgoMotion motion = steady_motion(Vector3d::Zero(), Vector3d::Zero(), 1. / 30);
    result = &filter.step(corners, k == 0 ? EgoMotion{} : motion);
  }
  return result->reasons.back();
}

TEST(Constellation, ACornerBesideABodyIsNotCarriedAlongByItsVotesAlone) {
  EXPECT_EQ(of_a_corner_beside_a_body(with("constellation.vote_own_past", "1000")), Reason::voted)
      << "the corner is no trap: the test shows nothing";
  EXPECT_NE(of_a_corner_beside_a_body(preset("default")), Reason::voted);
}

/// Rebels at the end among twelve corners that move alike, 130 px and more apart.
std::ptrdiff_t found_of_a_wide_group(const Parameters& parameters) {
  Filter filter(vga(), parameters);
  std::ptrdiff_t found = 0;
  for (int k = 0; k < 8; ++k) {
    Corners corners;
    for (int i = 0; i < 12; ++i) {
      // not quite a grid, which would be its own past when shifted
      const int x = 40 + 140 * (i % 4) + 7 * i % 11, y = 60 + 150 * (i / 4) + 5 * i % 13;
      corners.push_back(Eigen::Vector2i(x + 5 * k, y + 2 * k).cast<float>());
    }
    found = rebels(filter.step(corners, steady_motion(Vector3d::Zero(), Vector3d::Zero(), 0.1)));
  }
  return found;
}

TEST(Constellation, NeighboursTooFarToBeCountedVoteAllTheSame) {
  ASSERT_FALSE(NearestMap(640, 480).can_count({320, 240}, 130));
  EXPECT_EQ(found_of_a_wide_group(with("constellation.radius", "600")), 12);
  EXPECT_EQ(found_of_a_wide_group(preset("default")), 0) << "none is near: the test shows nothing";
}

/// Right side of the only square, after a body of 4 by 4 corners has moved for some frames. With
/// the last one a corner appears 30 px to its right.
double right_side_of_a_body(bool with_new_corner) {
  Filter filter(vga(), preset("default"));
  constexpr int kFrames = 8;
  const FrameResult* result = nullptr;
  for (int k = 0; k < kFrames; ++k) {
    Corners corners;
    for (int i = 0; i < 16; ++i) {
      const int x = 200 + 17 * (i % 4) + 7 * i % 5, y = 200 + 19 * (i / 4) + 5 * i % 7;
      corners.push_back(Eigen::Vector2i(x + 5 * k, y).cast<float>());
    }
    if (with_new_corner && k == kFrames - 1) corners.emplace_back(300 + 5 * k, 220);
    result = &filter.step(corners, steady_motion(Vector3d::Zero(), Vector3d::Zero(), 0.1));
    if (k == kFrames - 1) {
      EXPECT_EQ(rebels(*result), std::ssize(corners));
    }
  }
  EXPECT_EQ(result->layers.squares.size(), 1u);
  const Square& square = result->layers.squares.front();
  return square.location.x() + square.half_size.x();
}

TEST(Constellation, ACornerThatAppearsOnABodyIsInItsSquareAtOnce) {
  // It has no past and is no edge: it takes after those beside it.
  EXPECT_LT(right_side_of_a_body(false), 300);
  EXPECT_NEAR(right_side_of_a_body(true), 300 + 5 * 7, 1e-9);
}

TEST(Constellation, AnEdgeThatFollowsAMoverStepByStepLosesItByItsPath) {
  // A single corner: no neighbours vote. It moves by 0.8 px a frame across the field.
  for (const bool checked : {true, false}) {
    Filter filter(vga(), with("constellation.path_across", checked ? "2" : "1000"));
    int longest = 0;
    for (int k = 0; k < 40; ++k) {
      const Corners corners{{420, 150 + 0.8f * static_cast<float>(k)}};
      const EgoMotion motion = steady_motion({0.5, 0, 0}, Vector3d::Zero(), 0.1);
      const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
      for (const Edge& edge : result.layers.normal_edges) {
        if (edge.corner >= 0) longest = std::max(longest, edge.age);
      }
    }
    if (checked) {
      EXPECT_LE(longest, 4);
    } else {
      EXPECT_GE(longest, 20) << "the gates lose it anyway: the test shows nothing";
    }
  }
}

TEST(Constellation, AStaticEdgeKeepsToItsPathHoweverLong) {
  World world = sparse_world(7);
  const EgoMotion motion = steady_motion({0.1, 0, 0.3}, {0.01, 0.03, -0.02}, 0.1);
  Filter filter(world.camera, preset("default"));
  Random random(8);
  for (int k = 0; k < 40; ++k) {
    Corners corners = world.corners();
    for (Vector2f& x : corners) {  // what a detector's whole pixels add
      x += Vector2f(static_cast<float>(random.uniform(-0.5, 0.5)),
                    static_cast<float>(random.uniform(-0.5, 0.5)));
    }
    const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    EXPECT_EQ(rebels(result), 0);
    if (k >= 8) {
      const auto normal =
          std::count(result.verdicts.begin(), result.verdicts.end(), Verdict::normal);
      EXPECT_GT(static_cast<double>(normal), 0.9 * static_cast<double>(corners.size()));
    }
    world.advance(motion);
  }
}

TEST(Constellation, AStaticCornerBesideASlowMoverIsNotCarriedAlong) {
  // One of a slow group is hidden, and where it was last a static corner is found from then on.
  const Corners group{{200, 200}, {209, 197}, {204, 211}, {219, 206}, {213, 217}, {222, 195}};
  constexpr std::size_t kHidden = 2;
  const EgoMotion still = steady_motion(Vector3d::Zero(), Vector3d::Zero(), 0.1);
  for (const char* proof : {"4", "1000"}) {
    Filter filter(vga(), with("constellation.path_proof", proof));
    int carried = 0;
    for (int k = 0; k < 20; ++k) {
      Corners corners = group;
      for (std::size_t i = 0; i < corners.size(); ++i) {
        corners[i].x() += 1.6f * static_cast<float>(i == kHidden ? std::min(k, 3) : k);
      }
      for (const Edge& edge : filter.step(corners, still).layers.rebel_edges) {
        if (edge.corner == static_cast<int>(kHidden)) carried = std::max(carried, edge.age);
      }
    }
    if (std::string_view(proof) == "4") {
      EXPECT_LE(carried, 5);
    } else {
      EXPECT_GE(carried, 10) << "it is let go anyway: the test shows nothing";
    }
  }
}

TEST(Constellation, AnObjectThatDisappearsLeavesNoCircle) {
  Filter filter(vga(), preset("default"));
  const EgoMotion still = steady_motion(Vector3d::Zero(), Vector3d::Zero(), 0.1);
  Corners group{{200, 200}, {209, 197}, {204, 211}, {219, 206}, {213, 217}};
  for (int k = 0; k < 8; ++k) {
    filter.step(group, still);
    for (Vector2f& x : group) x.x() += 8;
  }
  ASSERT_EQ(filter.step(group, still).layers.rebel_circles.size(), 1u);
  int frames = 0;
  while (!filter.step(Corners{}, still).layers.rebel_circles.empty()) ++frames;
  EXPECT_LE(frames, 2);
}

}  // namespace
}  // namespace lcs
