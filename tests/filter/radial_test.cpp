/// Bodies that move along the line of sight: they are found by where they seem to stand.
#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "filter/filter.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using testing::Random;
using testing::steady_motion;
using testing::World;

constexpr double kDt_s = 0.1, kHeight_m = 0.5;

/// Answers each gap alike.
class Answer : public GapView {
 public:
  explicit Answer(std::optional<double> evidence) : evidence_(evidence) {}
  void begin(const EgoMotion&) override {}
  std::optional<double> evidence(const Gap& gap) override {
    gaps.push_back(gap);
    return evidence_;
  }
  std::vector<Gap> gaps;

 private:
  std::optional<double> evidence_;
};

/// A camera 0.5 m above a ground of points drives ahead at 0.3 m/s. A flat body of 0.4 m x 0.6 m is
/// in front of it. No points are behind the body, as it would not hide them.
struct Drive {
  Drive(double body_m, double body_speed_mps, double foot_m = 0) {
    Random random(7);
    for (int i = 0; i < 400; ++i) {
      const double side = i % 2 == 0 ? 1 : -1, depth_m = random.uniform(1.2, 9);
      world.points.push_back({{side * random.uniform(0.2, 0.8) * depth_m, kHeight_m, depth_m}});
    }
    for (int i = 0; i < 150; ++i) {  // walls
      const double side = i % 2 == 0 ? 1 : -1;
      world.points.push_back(
          {{side * random.uniform(2.5, 8), kHeight_m - random.uniform(0, 5), 11}});
    }
    body = world.points.size();
    for (int i = 0; i < 60; ++i) {
      const double up_m = foot_m + random.uniform(0, 0.6);
      world.points.push_back(
          {{random.uniform(-0.2, 0.2), kHeight_m - up_m, body_m}, {0, 0, body_speed_mps}});
    }
    motion.ground = Ground{.up_C = {0, -1, 0}, .height_m = kHeight_m};
  }

  /// Share of the body's corners that are rebels after these frames, and the number of other
  /// corners that are called comers or goers.
  struct Found {
    double of_body;
    std::ptrdiff_t others;
  };
  Found found(int frames, GapView* view) {
    Filter filter(world.camera);
    Found found{};
    for (int k = 0; k < frames; ++k) {
      std::vector<Eigen::Vector2f> corners = world.corners();
      for (auto& x : corners) x = x.array().round();
      EgoMotion told = motion;
      if (k == 0) told.dt_s = 0;
      result = filter.step(corners, world.signatures(static_cast<std::uint64_t>(k)), told, view);
      std::ptrdiff_t own = 0, rebels = 0, c = 0;
      found.others = 0;
      for (std::size_t i = 0; i < world.points.size(); ++i) {
        if (!world.image(world.points[i])) continue;
        const Reason reason = result.reasons[c];
        const bool is_rebel = result.verdicts[c++] == Verdict::rebel;
        own += i >= body;
        rebels += i >= body && is_rebel;
        found.others += i < body && (reason == Reason::comer || reason == Reason::goer);
      }
      found.of_body =
          static_cast<double>(rebels) / static_cast<double>(std::max<std::ptrdiff_t>(own, 1));
      world.advance(motion);
    }
    return found;
  }

  World world;
  std::size_t body;
  EgoMotion motion = steady_motion({0, 0, 0.3}, Eigen::Vector3d::Zero(), kDt_s);
  FrameResult result;
};

TEST(Comers, AreRebelsWhereThePictureShowsTheGroundBelowThem) {
  Answer ground(3);
  const auto [of_body, others] = Drive(5, -0.7).found(25, &ground);
  EXPECT_GT(of_body, 0.8);
  EXPECT_LT(others, 10);
  ASSERT_FALSE(ground.gaps.empty());
}

TEST(Comers, AreNotCalledByAPictureOfTheBodyOrByNone) {
  Answer body(-3), nothing(std::nullopt);
  for (GapView* view : {static_cast<GapView*>(&body), static_cast<GapView*>(&nothing),
                        static_cast<GapView*>(nullptr)}) {
    EXPECT_LT(Drive(5, -0.7).found(25, view).of_body, 0.1);
  }
  EXPECT_FALSE(body.gaps.empty());
}

TEST(Comers, AreNotCalledWithoutAGround) {
  Answer ground(3);
  Drive drive(5, -0.7);
  drive.motion.ground.reset();
  EXPECT_LT(drive.found(25, &ground).of_body, 0.1);
  EXPECT_TRUE(ground.gaps.empty());
}

/// With a gap below it that would be taken for the ground.
TEST(Comers, AreNotWhatStands) {
  Answer ground(3);
  const auto [of_body, others] = Drive(4, 0).found(25, &ground);
  EXPECT_LT(of_body, 0.1);
  EXPECT_LT(others, 10);
}

/// The gap reaches from the body's foot to the row of the ground at the body's apparent depth.
TEST(Comers, AskForTheGapBelowTheirFoot) {
  Answer ground(3);
  Drive drive(5, -0.7);
  drive.found(25, &ground);
  const double true_depth_m = drive.world.points[drive.body].x_C.z();
  // Static, it would be at the depth Z with 0.3 / Z = 1 / (its true depth / relative speed).
  const double apparent_pm = (1 / 0.3) / (true_depth_m + 0.1);
  const double foot_px = 239.5 + 415.7 * kHeight_m / (true_depth_m + 0.1);
  ASSERT_TRUE(drive.result.gaps && !drive.result.gaps->empty());
  const Gap& gap = std::ranges::max_element(*drive.result.gaps, {}, [](const GapSeen& seen) {
                     return seen.gap.inverse_depth_pm;
                   })->gap;
  EXPECT_NEAR(gap.inverse_depth_pm, apparent_pm, 0.1 * apparent_pm);
  EXPECT_NEAR(gap.place_px.y(), foot_px, 6);
  EXPECT_NEAR(gap.at(0, gap.rows).y(), std::min(479.0, 239.5 + 415.7 * kHeight_m * apparent_pm),
              20);
  EXPECT_TRUE(gap.across.isApprox(Vec2::UnitX()));
}

/// The lower half of the body is below the ground's bound and a rebel; the upper half is above the
/// horizon, where no bound is.
TEST(Goers, JoinTheRebelsThatTheyStandOn) {
  Drive drive(1.5, 0.25);
  const auto [of_body, others] = drive.found(25, nullptr);
  EXPECT_GT(of_body, 0.8);
  EXPECT_LT(others, 10);
  const auto goers = std::ranges::count(drive.result.reasons, Reason::goer);
  EXPECT_GT(goers, 5);
}

TEST(Goers, AreNotTheWorldBehindWhatCrosses) {
  Drive drive(2.5, 0);
  for (std::size_t i = drive.body; i < drive.world.points.size(); ++i) {
    drive.world.points[i].velocity_C = {0.3, 0, 0};
  }
  EXPECT_LT(drive.found(8, nullptr).others, 15);
}

/// Circles and edges of radial movers are the rebels' in all layers.
TEST(RadialMovers, AreRebelsInAllLayers) {
  Answer ground(3);
  Drive drive(5, -0.7);
  drive.found(25, &ground);
  const Layers& layers = drive.result.layers;
  ASSERT_FALSE(layers.rebel_circles.empty());
  EXPECT_TRUE(std::ranges::is_sorted(layers.rebel_edges, {}, &Edge::id));
  EXPECT_TRUE(std::ranges::is_sorted(layers.normal_edges, {}, &Edge::id));
  for (std::size_t c = 0; c < layers.rebel_circles.size(); ++c) {
    EXPECT_EQ(std::ranges::count(layers.rebel_edges, static_cast<int>(c), &Edge::circle),
              layers.rebel_circles[c].members);
    EXPECT_TRUE(layers.rebel_circles[c].rebel);
  }
  for (const Edge& edge : layers.rebel_edges) {
    EXPECT_TRUE(edge.rebel);
    if (edge.corner < 0) continue;
    EXPECT_EQ(drive.result.verdicts[edge.corner], Verdict::rebel);
  }
  for (const Edge& edge : layers.normal_edges) {
    if (edge.corner < 0) continue;
    EXPECT_EQ(drive.result.verdicts[edge.corner], Verdict::normal);
  }
  EXPECT_TRUE(
      std::ranges::any_of(layers.squares, [](const Square& s) { return s.rebel_circles > 0; }));
}

}  // namespace
}  // namespace lcs
