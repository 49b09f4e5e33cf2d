#include "filter/squares/convex_hull.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <vector>

#include "tests/filter/world.h"

namespace lcs {
namespace {

using testing::Random;

Outline hull_of(const std::vector<Vec2>& points) {
  ConvexHull hull;
  for (const Vec2& point : points) hull.add(point);
  return hull.outline();
}

std::vector<Vec2> list_of(const Outline& outline) {
  return {outline.vertices().begin(), outline.vertices().end()};
}

double cross(const Vec2& a, const Vec2& b) {
  return a.x() * b.y() - a.y() * b.x();
}

/// Distance of a point outside the outline, px; negative inside.
double outside(const Outline& outline, const Vec2& point) {
  const auto vertices = outline.vertices();
  double most = -1e9;
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const Vec2 side = vertices[(i + 1) % vertices.size()] - vertices[i];
    most = std::max(most, -cross(side, point - vertices[i]) / side.norm());
  }
  return most;
}

/// Whether each turn is clockwise: a positive cross product, since y points down.
bool is_convex(const Outline& outline) {
  const auto v = outline.vertices();
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vec2 &a = v[i], &b = v[(i + 1) % v.size()], &c = v[(i + 2) % v.size()];
    if (!(cross(b - a, c - b) > 0)) return false;
  }
  return true;
}

/// Whole pixels, like corners: many are collinear, and some occur twice.
std::vector<Vec2> pixels(Random& random, int count, double size) {
  std::vector<Vec2> points;
  for (int i = 0; i < count; ++i) {
    points.emplace_back(std::round(random.uniform(0, size)), std::round(random.uniform(0, size)));
  }
  return points;
}

TEST(ConvexHull, OfASquareWithPointsInItAndOnItsSidesIsTheSquare) {
  const Outline outline = hull_of(
      {{20, 10}, {15, 15}, {10, 20}, {15, 10}, {20, 20}, {10, 10}, {10, 15}, {20, 20}, {11, 19}});
  EXPECT_EQ(list_of(outline), (std::vector<Vec2>{{10, 10}, {20, 10}, {20, 20}, {10, 20}}))
      << "clockwise as the picture is seen, from the leftmost on";
}

TEST(ConvexHull, OfOnePointIsItAndOfALineItsEnds) {
  EXPECT_EQ(list_of(hull_of({{3, 4}, {3, 4}})), (std::vector<Vec2>{{3, 4}}));
  EXPECT_EQ(list_of(hull_of({{3, 3}, {1, 1}, {5, 5}, {2, 2}})),
            (std::vector<Vec2>{{1, 1}, {5, 5}}));
  EXPECT_EQ(list_of(hull_of({{3, 9}, {3, 1}, {3, 5}})), (std::vector<Vec2>{{3, 1}, {3, 9}}));
}

TEST(ConvexHull, IsConvexOfItsPointsAndHoldsThemAll) {
  Random random(1);
  for (int i = 0; i < 300; ++i) {
    const std::vector<Vec2> points = pixels(random, 3 + i % 40, i % 2 == 0 ? 60 : 9);
    const Outline outline = hull_of(points);
    if (outline.count < 3) continue;
    EXPECT_TRUE(is_convex(outline));
    for (const Vec2& point : points) EXPECT_LE(outside(outline, point), 1e-9);
    for (const Vec2& vertex : outline.vertices()) {
      EXPECT_NE(std::find(points.begin(), points.end(), vertex), points.end());
    }
  }
}

TEST(ConvexHull, IsTheSameInWhateverOrderPointsCome) {
  Random random(2);
  ConvexHull kept;
  for (int i = 0; i < 50; ++i) {
    std::vector<Vec2> points = pixels(random, 30, 50);
    const std::vector<Vec2> before = list_of(hull_of(points));
    std::rotate(points.begin(), points.begin() + 11, points.end());
    std::swap(points[2], points[20]);
    kept.clear();
    for (const Vec2& point : points) kept.add(point);
    EXPECT_EQ(list_of(kept.outline()), before);
  }
}

/// Mirroring and a quarter turn give the same vertices with another start vertex.
TEST(ConvexHull, IsMirroredAndTurnedWithThePicture) {
  Random random(3);
  const auto by_place = [](std::vector<Vec2> points) {
    std::sort(points.begin(), points.end(), [](const Vec2& a, const Vec2& b) {
      return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y());
    });
    return points;
  };
  for (int i = 0; i < 100; ++i) {
    const std::vector<Vec2> points = pixels(random, 5 + i, 80);
    for (const auto& move : {+[](const Vec2& x) { return Vec2(639 - x.x(), x.y()); },
                             +[](const Vec2& x) { return Vec2(x.x(), 479 - x.y()); },
                             +[](const Vec2& x) { return Vec2(479 - x.y(), x.x()); }}) {
      std::vector<Vec2> moved, expected;
      for (const Vec2& point : points) moved.push_back(move(point));
      for (const Vec2& vertex : list_of(hull_of(points))) expected.push_back(move(vertex));
      const Outline outline = hull_of(moved);
      EXPECT_EQ(by_place(list_of(outline)), by_place(expected));
      if (outline.count >= 3) {
        EXPECT_TRUE(is_convex(outline));
      }
    }
  }
}

/// A circle of 200 points has 200 vertices.
TEST(ConvexHull, OfMoreVerticesThanThereIsRoomForItHasThoseThatReachFarthest) {
  std::vector<Vec2> circle;
  for (int i = 0; i < 200; ++i) {
    const double angle = 0.001 + i * std::numbers::pi / 100;
    circle.emplace_back(300 + 100 * std::cos(angle), 200 + 100 * std::sin(angle));
  }
  const Outline outline = hull_of(circle);
  EXPECT_EQ(outline.count, Outline::kMost);
  EXPECT_TRUE(is_convex(outline));
  // An arc of 1/32 of a circle rises above its chord by 0.5 % of the radius.
  for (const Vec2& point : circle) EXPECT_LE(outside(outline, point), 0.6);
  ConvexHull hull;
  double left = 1e9;
  for (const Vec2& point : circle) {
    hull.add(point);
    left = std::min(left, point.x());
  }
  EXPECT_EQ(hull.box().first.x(), left);
  EXPECT_EQ(outline.places[0].x(), left);
}

TEST(Place, MovesAndStretchesTheOutlineWithItsBox) {
  Square square;
  square.location = {15, 30};
  square.half_size = {5, 10};
  square.outline = hull_of({{10, 25}, {15, 20}, {20, 30}, {12, 40}});
  place(square, {100, 50}, {10, 10});
  EXPECT_EQ(square.location, Vec2(100, 50));
  EXPECT_EQ(square.half_size, Vec2(10, 10));
  EXPECT_EQ(list_of(square.outline), (std::vector<Vec2>{{90, 45}, {100, 40}, {110, 50}, {94, 60}}));
  place(square, {100, 50}, {0, 10});
  place(square, {0, 0}, {3, 10});  // with zero width there is nothing to stretch
  for (const Vec2& vertex : square.outline.vertices()) EXPECT_EQ(vertex.x(), 0);
}

}  // namespace
}  // namespace lcs
