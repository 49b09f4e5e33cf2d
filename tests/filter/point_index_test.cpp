#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "filter/hit_map.h"
#include "filter/hit_screen.h"
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
  for (const double cell : {0.0, 1.0, 16.0, 300.0}) {
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

TEST(PointGrid, FindsTheNearestInOrderWhateverTheCells) {
  Random random(4);
  PointGrid grid;
  std::vector<Neighbour> found;
  for (const double cell : {1.0, 16.0, 300.0}) {
    std::vector<Vec2> points = random_points(random, 200);
    for (Vec2& x : points) x = Vec2(std::round(x.x() / 8), std::round(x.y() / 8));  // ties
    grid.build(points, cell);
    for (int i = 0; i < 200; ++i) {
      const Vec2 x(std::round(random.uniform(-20, 110)), random.uniform(-20, 80));
      const double radius = random.uniform(0, 60);
      const std::size_t count = static_cast<std::size_t>(random.uniform(0, 12));
      const auto accept = [](int p) { return p % 3 != 0; };
      std::vector<std::pair<double, int>> expected;
      for (int p = 0; p < 200; ++p) {
        const double distance2 = (points[p] - x).squaredNorm();
        if (accept(p) && distance2 <= radius * radius) expected.emplace_back(distance2, p);
      }
      std::sort(expected.begin(), expected.end());
      if (expected.size() > count) expected.resize(count);
      grid.nearest(x, radius, count, accept, found);
      std::vector<std::pair<double, int>> in_order;
      for (const Neighbour& here : found) in_order.emplace_back(here.distance2, here.index);
      EXPECT_EQ(in_order, expected);
    }
  }
}

TEST(PointGrid, KnowsWhetherThereIsAnyWithinTheRadius) {
  PointGrid grid;
  const std::vector<Vec2> points = {{10, 10}, {90, 40}};
  grid.build(points, 20);
  EXPECT_TRUE(grid.any_within({13, 14}, 5));
  EXPECT_FALSE(grid.any_within({13, 14}, 4.99));
  EXPECT_FALSE(grid.any_within({50, 25}, 40));
  grid.build({}, 20);
  EXPECT_FALSE(grid.any_within({0, 0}, 100));
}

TEST(PointGrid, FindsNothingNearestAmongNone) {
  PointGrid grid;
  std::vector<Neighbour> found(3);
  grid.build({}, 10);
  grid.nearest(
      {5, 5}, 100, 4, [](int) { return true; }, found);
  EXPECT_TRUE(found.empty());
}

Discs discs(int width_px, int height_px, std::span<const Vec2> points, double radius_px) {
  Discs discs(width_px, height_px);
  discs.build(points, radius_px);
  return discs;
}

TEST(HitMap, KnowsThePixelsWithinTheRadiusOfAPoint) {
  Random random(5);
  for (const int width : {63, 64, 65, 200}) {
    HitMap map(width, 48);
    for (const double radius : {0.3, 2.0, 3.0, 7.5}) {
      std::vector<Vec2> points;
      for (int i = 0; i < 20; ++i) {
        points.emplace_back(random.uniform(-5, width + 5), random.uniform(-5, 53));
      }
      // A pixel's centre at the radius itself is within it.
      points.emplace_back(10, 10);
      map.build(discs(width, 48, points, radius));
      for (int v = 0; v < 48; ++v) {
        for (int u = 0; u < width; ++u) {
          const bool near = std::any_of(points.begin(), points.end(), [&](const Vec2& p) {
            const bool inside = p.x() > -0.5 && p.y() > -0.5 && p.x() < width - 0.5 && p.y() < 47.5;
            return inside && (p - Vec2(u, v)).squaredNorm() <= radius * radius;
          });
          ASSERT_EQ(map.at(Vec2(u, v)), near) << u << ", " << v << " within " << radius;
        }
      }
    }
  }
}

TEST(HitMap, ForgetsTheLastPointsAndFindsNothingOutside) {
  HitMap map(64, 48);
  const std::vector<Vec2> first = {{10, 10}}, second = {{63, 40}};
  map.build(discs(64, 48, first, 2));
  map.build(discs(64, 48, second, 2));
  EXPECT_FALSE(map.at({10, 10}));
  EXPECT_TRUE(map.at({63.49, 40}));
  EXPECT_FALSE(map.at({63.5, 40}));
  EXPECT_FALSE(map.at({-1, 5}));
  EXPECT_FALSE(map.at({1e9, -1e9}));
}

TEST(HitScreen, LetsThroughAllThatHit) {
  Random random(7);
  HitMap exact(120, 90);
  HitScreen screen(120, 90);
  int hits = 0, let_through = 0, looked_up = 0;
  for (int round = 0; round < 20; ++round) {
    std::vector<Vec2> points, arms;
    for (int i = 0; i < 30; ++i) {
      points.emplace_back(random.uniform(-5, 125), random.uniform(-5, 95));
      const Eigen::Vector3d direction = random.vector(1);
      arms.push_back(direction.head<2>() * (HitScreen::kLongestArm_px / std::sqrt(2)));
    }
    exact.build(discs(120, 90, points, 2));
    screen.build(discs(120, 90, points, 2));
    std::vector<HitScreen::Offset> offsets;
    for (const Vec2& arm : arms) offsets.push_back(screen.offset(arm));
    for (int i = 0; i < 40; ++i) {
      const Vec2 anchor(random.uniform(-0.499, 119.499), random.uniform(-0.499, 89.499));
      std::vector<std::uint8_t> listed(arms.size() + 1);
      const int count = HitScreen::count(screen.anchor(anchor), offsets);
      HitScreen::list(screen.anchor(anchor), offsets, listed.data());
      listed.resize(count);
      for (std::size_t a = 0; a < arms.size(); ++a) {
        const bool listing = std::find(listed.begin(), listed.end(), a) != listed.end();
        if (exact.at(anchor + arms[a])) {
          EXPECT_TRUE(listing);
          ++hits;
        }
        let_through += listing;
        ++looked_up;
      }
    }
  }
  // A disc of radius 2 has 13 pixels, and a pixel to every side of it makes at most 37.
  EXPECT_GT(hits, 100);
  EXPECT_LT(let_through, 4 * hits);
  EXPECT_LT(let_through, looked_up / 2);
}

TEST(HitScreen, HasNoAnchorOutsideTheImageAndForgetsTheLastPoints) {
  HitScreen screen(64, 48);
  EXPECT_EQ(screen.anchor({-0.5, 10}), nullptr);
  EXPECT_EQ(screen.anchor({10, 47.5}), nullptr);
  const std::vector<Vec2> first = {{10, 10}}, second = {{0, 47}};
  const std::vector<HitScreen::Offset> arms = {screen.offset({0, 0})};
  screen.build(discs(64, 48, first, 2));
  screen.build(discs(64, 48, second, 2));
  EXPECT_EQ(HitScreen::count(screen.anchor({10, 10}), arms), 0);
  EXPECT_EQ(HitScreen::count(screen.anchor({0, 47}), arms), 1);
}

TEST(Pixels, RoundAsTheStandardLibraryDoes) {
  Random random(6);
  std::vector<double> coordinates = {-0.49, -0.0, 0.0, 0.49999999999999994, 0.5, 1.5, 2.5, 639.49};
  for (int i = 0; i < 1000; ++i) coordinates.push_back(random.uniform(-0.5, 700));
  for (const double x : coordinates) EXPECT_EQ(nearest_pixel(x), std::lround(x)) << x;
}

TEST(NearestMap, AnswersLikeASearchOverAllPoints) {
  Random random(2);
  NearestMap map(640, 480);
  for (const double radius : {0.6, 2.0, 3.0}) {
    const std::vector<Vec2> points = random_points(random, 400);
    map.build(points, discs(640, 480, points, radius));
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
  map.build(first, discs(64, 48, first, 2));
  map.build(second, discs(64, 48, second, 2));
  EXPECT_EQ(map.at({10, 10}), -1);
  EXPECT_EQ(map.at({40, 40}), 0);
  EXPECT_EQ(map.at({-1, 5}), -1);
  EXPECT_EQ(map.at({64, 5}), -1);
  EXPECT_EQ(map.at({1e9, -1e9}), -1);
}

}  // namespace
}  // namespace lcs
