#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "filter/nearest_map.h"
#include "filter/point_grid.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using testing::Random;

std::vector<Vec2> random_points(Random& random, int count) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(random.uniform(-50, 700), random.uniform(-50, 500));
  }
  return points;
}

TEST(PointGrid, FindsExactlyWhatIsWithinTheRadius) {
  Random random(1);
  PointGrid grid;
  for (const double cell : {1.0, 16.0, 300.0}) {
    const std::vector<Vec2> points = random_points(random, 300);
    grid.build(points, cell);
    for (int i = 0; i < 50; ++i) {
      const Vec2 x(random.uniform(-100, 750), random.uniform(-100, 550));
      const double radius = random.uniform(0, 120);
      std::multiset<int> found, expected;
      grid.visit_within(x, radius, [&](int p, double) { found.insert(p); });
      for (std::size_t p = 0; p < points.size(); ++p) {
        if ((points[p] - x).norm() <= radius) expected.insert(static_cast<int>(p));
      }
      EXPECT_EQ(found, expected);
    }
  }
}

TEST(PointGrid, TakesNoneOneAndCoincidentPoints) {
  PointGrid grid;
  int found = 0;
  const auto count = [&](int, double) { ++found; };
  grid.build({}, 10);
  grid.visit_within({0, 0}, 1000, count);
  EXPECT_EQ(found, 0);
  const std::vector<Vec2> same(5, Vec2(3, 4));
  grid.build(same, 10);
  grid.visit_within({3, 4}, 0, count);
  EXPECT_EQ(found, 5);
}

TEST(PointGrid, KeepsItsSizeWhenPointsLieFarApart) {
  PointGrid grid;
  const std::vector<Vec2> points = {{0, 0}, {1e12, -1e12}};
  grid.build(points, 1);
  int found = 0;
  grid.visit_within({1e12, -1e12}, 5, [&](int, double) { ++found; });
  EXPECT_EQ(found, 1);
}

TEST(NearestMap, AnswersLikeASearchOverAllPoints) {
  Random random(2);
  NearestMap map(640, 480);
  for (const double radius : {0.6, 2.0, 3.0}) {
    const std::vector<Vec2> points = random_points(random, 400);
    map.build(points, radius);
    for (int v = 0; v < 480; v += 3) {
      for (int u = 0; u < 640; u += 3) {
        double nearest = radius;
        bool any = false;
        for (const Vec2& p : points) {
          // Only points in the image are found.
          if (p.x() <= -0.5 || p.y() <= -0.5 || p.x() >= 639.5 || p.y() >= 479.5) continue;
          const double d = (p - Vec2(u, v)).norm();
          if (d <= nearest) {
            nearest = d;
            any = true;
          }
        }
        const int found = map.at(Vec2(u, v));
        ASSERT_EQ(found >= 0, any);
        if (any) {
          EXPECT_DOUBLE_EQ((points[found] - Vec2(u, v)).norm(), nearest);
        }
      }
    }
  }
}

TEST(NearestMap, ForgetsTheLastPointsAndFindsNothingOutside) {
  NearestMap map(64, 48);
  const std::vector<Vec2> first = {{10, 10}}, second = {{40, 40}};
  map.build(first, 2);
  map.build(second, 2);
  EXPECT_EQ(map.at({10, 10}), -1);
  EXPECT_EQ(map.at({40, 40}), 0);
  EXPECT_EQ(map.at({-1, 5}), -1);
  EXPECT_EQ(map.at({64, 5}), -1);
  EXPECT_EQ(map.at({1e9, -1e9}), -1);
}

}  // namespace
}  // namespace lcs
