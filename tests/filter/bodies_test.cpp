/// Bodies that were seen to move, while they are slow, stand or are hidden.
#include "filter/squares/bodies.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "filter/kinematics/geometry.h"
#include "filter/squares/square_expert.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using testing::ahead;
using testing::vga;

/// The experts of circles, squares and bodies, frame after frame at 10 Hz.
struct Experts {
  CircleExpert circles{vga(), {}, {}};
  SquareExpert squares{vga(), {}};
  Bodies bodies{vga(), {}, CircleParameters{}.trust};
  std::optional<Ground> ground;
  BothKinds<Edge> edges;

  /// Adds a grid of edges, 10 px apart, to the next frame.
  /// \param depth_m of normal edges; 0: unknown.
  void add(Id first, const Vec2& low, const Vec2& size, bool rebel, double depth_m = 0) {
    for (double y = 0; y <= size.y(); y += 10) {
      for (double x = 0; x <= size.x(); x += 10) {
        Edge edge;
        edge.id = first++;
        edge.rebel = rebel;
        edge.location = low + Vec2(x, y);
        edge.speed = rebel ? 50 : 0;
        edge.corner = 0;
        if (depth_m > 0) {
          edge.depth_ratio = FieldParameters{}.reference_depth_m / depth_m;
          edge.depth_ratio_sigma = 0.01 * edge.depth_ratio;
        }
        (rebel ? edges.rebel : edges.normal).push_back(edge);
      }
    }
  }

  std::vector<Square> step() {
    const MotionField field = ahead(ground);
    const CircleExpert::Result& found = circles.step(edges, field);
    const std::vector<Square> all =
        bodies.step(edges, found, squares.step(edges, found, field), field);
    edges = {};
    return all;
  }

  /// A body of 40 px x 60 px moves by 5 px in each of five frames, from x = 100 to x = 120.
  Square move() {
    std::vector<Square> all;
    for (int k = 0; k < 5; ++k) {
      add(1, {100.0 + 5 * k, 200}, {40, 60}, true);
      all = step();
      EXPECT_EQ(all.size(), 1u);
    }
    EXPECT_EQ(all.at(0).circles, 1);
    EXPECT_EQ(all.at(0).rebel_circles, 1);
    EXPECT_NEAR(all.at(0).location.x(), 140, 1e-6);
    return all.at(0);
  }
};

TEST(Bodies, ThatStopKeepTheirBox) {
  Experts experts;
  const Square moved = experts.move();
  for (int k = 0; k < 10; ++k) {
    // No depth is known: they make no circle. Ever fewer edges are seen.
    experts.add(1, {120, 200}, {40, 60.0 - 10 * (k / 2)}, false);
    const std::vector<Square> all = experts.step();
    ASSERT_EQ(all.size(), 1u) << k;
    EXPECT_EQ(all[0].id, moved.id);
    EXPECT_EQ(all[0].circles, 0) << "it is of the memory";
    EXPECT_LT((all[0].location - moved.location).norm(), 1e-6);
    EXPECT_LT((all[0].half_size - moved.half_size).norm(), 1e-6);
    EXPECT_EQ(all[0].speed, 0);
  }
}

TEST(Bodies, AtRestAreOneSquareWithTheStaticCircleInTheirPlace) {
  Experts experts;
  const Square moved = experts.move();
  for (int k = 0; k < 3; ++k) {
    experts.add(101, {122, 200}, {40, 60}, false, 3);  // all tracks broke
    const std::vector<Square> all = experts.step();
    ASSERT_EQ(all.size(), 1u) << k;
    EXPECT_EQ(all[0].id, moved.id);
    EXPECT_NEAR(all[0].location.x(), 142, 1);
  }
}

TEST(Bodies, ThatAreHiddenMoveOnAndComeBackAsTheSame) {
  Experts experts;
  const Square moved = experts.move();
  for (int k = 1; k <= 4; ++k) {
    const std::vector<Square> all = experts.step();
    ASSERT_EQ(all.size(), 1u) << k;
    EXPECT_EQ(all[0].id, moved.id);
    EXPECT_EQ(all[0].circles, 0);
    EXPECT_NEAR(all[0].location.x(), 140 + 5 * k, 1e-6);
  }
  experts.add(101, {147, 200}, {40, 60}, true);
  const std::vector<Square> all = experts.step();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].id, moved.id);
  EXPECT_EQ(all[0].circles, 1);
  EXPECT_NEAR(all[0].location.x(), 167, 3);
}

/// Other edges at its place end a body, unless they are of something nearer than its foot.
TEST(Bodies, EndWhereSomethingElseIsSeen) {
  for (const bool nearer : {false, true}) {
    Experts experts;
    experts.ground = {.height_m = 0.45};
    experts.move();  // its foot, on row 264, is 7.5 m away
    experts.add(101, {110, 200}, {100, 60}, false, nearer ? 3 : 30);
    const std::vector<Square> all = experts.step();
    EXPECT_EQ(std::ranges::count(all, 0, &Square::circles), nearer ? 1 : 0);
  }
}

TEST(Bodies, ThatLeaveThePictureOrAreUnseenTooLongEnd) {
  Experts experts;
  experts.move();
  int frames = 0;
  while (!experts.step().empty() && frames < 100) ++frames;
  // Half of the width is about 21 px, and 0.8 / s * 50 px / s * t^2 / 2 exceeds it after 1.03 s.
  EXPECT_NEAR(frames, 10, 1);
}

TEST(Bodies, KeepTheBoxOfAllEdgesWhenFewMakeTheCircle) {
  Experts experts;
  const Square moved = experts.move();
  experts.add(1, {125, 200}, {40, 10}, true);
  const std::vector<Square> all = experts.step();
  ASSERT_EQ(all.size(), 1u);
  EXPECT_EQ(all[0].id, moved.id);
  EXPECT_GT(all[0].half_size.y(), 0.9 * moved.half_size.y());
}

TEST(Bodies, AreNoneInAStaticScene) {
  Experts experts;
  for (int k = 0; k < 5; ++k) {
    experts.add(1, {100, 200}, {40, 60}, false, 3);
    experts.add(101, {300, 200}, {40, 60}, false, 4);
    const std::vector<Square> all = experts.step();
    ASSERT_EQ(all.size(), 2u);
    for (const Square& square : all) {
      EXPECT_EQ(square.circles, 1);
      EXPECT_EQ(square.rebel_circles, 0);
    }
  }
}

/// A circle that was seen in fewer frames than trust needs leaves nothing.
TEST(Bodies, OfALateFalseAlarmDoNotLiveOn) {
  Experts experts;
  experts.add(1, {100, 200}, {40, 60}, true);
  EXPECT_EQ(experts.step().size(), 1u);
  EXPECT_TRUE(experts.step().empty());
}

}  // namespace
}  // namespace lcs
