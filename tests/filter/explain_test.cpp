/// The numbers by which the filter explains a verdict (`Filter::explain`): they are the ones that
/// made it, by the equations of MODEL.md in plain numbers (`scalar_track.h`).
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

#include "filter/edges/explanation.h"
#include "filter/filter.h"
#include "filter/kinematics/motion_field.h"
#include "tests/filter/scalar_track.h"
#include "tests/filter/small_drive.h"

namespace lcs {
namespace {

using testing::Random;
using testing::SmallDrive;

const Parameters kUsual;

/// The track in the state that an explanation holds.
testing::Track track_of(const Explanation::State& state) {
  Tracks one;
  one.columns.make(1);
  one.records.emplace_back();
  for (std::size_t column = 0; column < kTrackColumns; ++column) {
    one.columns[column][0] = state[column];
  }
  return testing::track_of(one, 0);
}

/// The small drive, and what the filter says of it.
struct Watched {
  SmallDrive drive;
  Filter filter{drive.world.camera};
  std::vector<Eigen::Vector2f> corners;
  FrameResult result;

  void go_on() {
    if (!corners.empty()) drive.world.advance(drive.motion);
    const EgoMotion motion = corners.empty() ? EgoMotion{} : drive.motion;
    corners = drive.world.corners();
    for (Eigen::Vector2f& x : corners) x = x.array().round();
    result = filter.step(corners, motion);
  }
  Explanation explain(std::size_t corner) const {
    return filter.explain(static_cast<int>(corner)).value();
  }
  MotionField field() const { return {drive.world.camera, drive.motion, kUsual.field}; }
  Vec2 place(std::size_t corner) const { return corners[corner].cast<double>(); }
};

/// Twenty corners of any frame but the first, by a seed. \param check gets the drive and a corner.
void for_twenty_corners(const auto& check) {
  Random random(20);
  Watched watched;
  watched.go_on();
  for (int frame = 1; frame <= 5; ++frame) {
    watched.go_on();
    for (int i = 0; i < 4; ++i) {
      const double at = random.uniform(0, static_cast<double>(watched.corners.size()));
      SCOPED_TRACE(::testing::Message() << "frame " << frame << " corner " << std::floor(at));
      check(watched, static_cast<std::size_t>(at));
    }
  }
}

TEST(Explain, TheDensitiesAreThoseOfPlainNumbers) {
  int checked = 0;
  for_twenty_corners([&](const Watched& watched, std::size_t corner) {
    const Explanation why = watched.explain(corner);
    if (why.assigned == 0) return;
    const testing::Track before = track_of(why.predicted);
    const double sigma2 = why.seen[kSeenNoise2];
    const testing::Densities densities =
        testing::densities_of(before, watched.place(corner), watched.drive.world.camera,
                              watched.field(), kUsual.edge, sigma2);
    EXPECT_NEAR(why.seen[kStaticDensity], densities.still_ppx2,
                2e-3 * densities.still_ppx2 + 1e-12);
    EXPECT_NEAR(why.seen[kMovingDensity], densities.moving_ppx2,
                2e-3 * densities.moving_ppx2 + 1e-12);
    EXPECT_NEAR(why.seen[kLogOddsBefore], densities.log_odds_before, 1e-4);
    ++checked;
  });
  EXPECT_GE(checked, 15);
}

TEST(Explain, TheLogOddsFollowFromTheDensities) {
  int checked = 0;
  for_twenty_corners([&](const Watched& watched, std::size_t corner) {
    const Explanation why = watched.explain(corner);
    if (why.assigned == 0 || why.assigned != why.track) return;
    const double dt = watched.drive.motion.dt_s, right = 1 - kUsual.edge.turnover(dt);
    const double phi = why.seen[kWrongDensity], most = kUsual.edge.most_log_odds(dt);
    const double L = why.seen[kLogOddsBefore] + std::log((right * why.seen[kMovingDensity] + phi) /
                                                         (right * why.seen[kStaticDensity] + phi));
    EXPECT_NEAR(why.seen[kLogOdds], std::clamp(L, -most, most), 1e-5 * (1 + std::abs(L)));
    ++checked;
  });
  EXPECT_GE(checked, 15);
}

TEST(Explain, TheBeliefFollowsFromTheNeighbours) {
  const double k0 = std::exp(-4.5);
  int coupled = 0;
  for_twenty_corners([&](const Watched& watched, std::size_t corner) {
    const Explanation why = watched.explain(corner);
    if (why.seen[kSightings] < 2) {
      EXPECT_TRUE(why.voices.empty());
      return;
    }
    const double dt = watched.drive.motion.dt_s;
    const double J = std::min(kUsual.edge.coupling, kUsual.edge.most_log_odds(dt));
    double all = k0, pull = -k0;
    for (const Voice& voice : why.voices) {
      EXPECT_NE(voice.corner, static_cast<int>(corner));
      all += double{voice.weight};
      pull += double{voice.weight} * double{voice.said};
    }
    EXPECT_NEAR(why.seen[kBelief], double{why.shown} + J * pull / all, 1e-4);
    EXPECT_TRUE(std::ranges::is_sorted(why.voices, std::ranges::greater(), &Voice::weight));
    coupled += !why.voices.empty();
  });
  EXPECT_GE(coupled, 15);
}

TEST(Explain, NeighboursTellEachOtherWithTheSameWeight) {
  for_twenty_corners([&](const Watched& watched, std::size_t corner) {
    for (const Voice& voice : watched.explain(corner).voices) {
      const Explanation other = watched.explain(static_cast<std::size_t>(voice.corner));
      const auto back = std::ranges::find(other.voices, static_cast<int>(corner), &Voice::corner);
      ASSERT_NE(back, other.voices.end());
      EXPECT_EQ(back->weight, voice.weight);
    }
  });
}

TEST(Explain, TheVerdictFollowsFromTheBelief) {
  int rebels = 0;
  for_twenty_corners([&](const Watched& watched, std::size_t corner) {
    const Explanation why = watched.explain(corner);
    const bool is_rebel = why.seen[kBelief] > 0;
    EXPECT_EQ(watched.result.verdicts[corner] == Verdict::rebel, is_rebel);
    EXPECT_EQ(watched.result.log_odds[corner], why.seen[kBelief]);
    rebels += is_rebel;
  });
  EXPECT_GE(rebels, 1);
}

TEST(Explain, TheTrackIsThatOfTheEdge) {
  Watched watched;
  for (int frame = 0; frame < 6; ++frame) watched.go_on();
  const auto& [normal, rebel] =
      std::tie(watched.result.layers.normal_edges, watched.result.layers.rebel_edges);
  ASSERT_FALSE(normal.empty());
  ASSERT_FALSE(rebel.empty());
  for (const auto* edges : {&normal, &rebel}) {
    for (const Edge& edge : *edges) {
      if (edge.corner < 0) continue;
      const Explanation why = watched.explain(static_cast<std::size_t>(edge.corner));
      EXPECT_EQ(why.track, edge.id);
      EXPECT_EQ(why.age, edge.age);
      if (why.assigned != why.track) continue;
      const TrackColumn x = edge.rebel ? kMovingX : kStaticX;
      EXPECT_EQ(Vec2(why.seen[x], why.seen[x + 1]), edge.predicted);
    }
  }
}

TEST(Explain, ACornerThatWasLeftOutHasNone) {
  Filter filter(testing::vga());
  EXPECT_FALSE(filter.explain(0)) << "before the first frame";
  filter.step(std::vector<Eigen::Vector2f>{{-5, 10}, {100, 100}}, EgoMotion{});
  EXPECT_FALSE(filter.explain(0)) << "outside of the picture";
  ASSERT_TRUE(filter.explain(1));
  EXPECT_EQ(filter.explain(1)->assigned, 0U);
  EXPECT_FALSE(filter.explain(2)) << "there is no such corner";
}

}  // namespace
}  // namespace lcs
