#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "filter/matching/couples.h"
#include "filter/matching/point_grid.h"
#include "filter/types/signature.h"
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
  const auto any_within = [&](const Vec2& x, double radius_px) {
    bool any = false;
    grid.visit_within(x, radius_px, [&](int, double) { any = true; });
    return any;
  };
  const std::vector<Vec2> points = {{10, 10}, {90, 40}};
  grid.build(points, 20);
  EXPECT_TRUE(any_within({13, 14}, 5));
  EXPECT_FALSE(any_within({13, 14}, 4.99));
  EXPECT_FALSE(any_within({50, 25}, 40));
  grid.build({}, 20);
  EXPECT_FALSE(any_within({0, 0}, 100));
}

TEST(PointGrid, VisitsEachPairOnceFromThePlaceOfItsFirst) {
  Random random(8);
  PointGrid grid;
  for (const double cell : {1.0, 16.0, 300.0}) {
    const std::vector<Vec2> points = random_points(random, 300);
    grid.build(points, cell);
    ASSERT_EQ(grid.size(), points.size());
    for (std::size_t place = 0; place < grid.size(); ++place) {
      const double radius = 20.0 + static_cast<double>(place % 50);
      const Vec2& x = points[grid.index_at(place)];
      std::vector<int> visits(points.size());
      grid.visit_runs_after(place, radius, [&](std::size_t first, std::size_t last) {
        ASSERT_GT(first, place);
        for (; first < last; ++first) ++visits[grid.index_at(first)];
      });
      for (std::size_t other = place + 1; other < grid.size(); ++other) {
        const int i = grid.index_at(other);
        EXPECT_LE(visits[i], 1);
        if ((points[i] - x).norm() <= radius) {
          EXPECT_EQ(visits[i], 1);
        }
      }
    }
  }
  grid.build({}, 20);
  EXPECT_EQ(grid.size(), 0u);
}

TEST(PointGrid, FindsInSinglePrecisionWhatItFindsInDouble) {
  Random random(9);
  PointGrid grid;
  std::vector<Vec2> points = random_points(random, 300);
  for (Vec2& x : points) x = x.array().round();  // so that squares are exact
  grid.build(points, 30);
  PointGrid::Found found;
  for (const double radius : {0.0, 5.0, 50.0, 2000.0}) {
    for (const Vec2& x : points) {
      std::map<int, double> expected, seen;
      grid.visit_within(x, radius, [&](int i, double distance2) { expected[i] = distance2; });
      const std::size_t count = grid.find_within(x, radius, found);
      for (std::size_t k = 0; k < count; ++k) {
        seen[grid.index_at(static_cast<std::size_t>(found.places[k]))] = found.distance2_px2[k];
      }
      EXPECT_EQ(seen, expected);
      EXPECT_EQ(grid.count_within(x, radius), expected.size());
    }
  }
}

/// Points on a regular grid with a spacing of `apart_px`.
std::vector<Vec2> even_points(double apart_px) {
  std::vector<Vec2> points;
  for (double y = 0; y < 480; y += apart_px) {
    for (double x = 0; x < 640; x += apart_px) points.emplace_back(x, y);
  }
  return points;
}

TEST(PointGrid, KnowsHowFarSoManyReach) {
  PointGrid grid;
  for (const double apart : {3.0, 8.0, 20.0}) {
    const std::vector<Vec2> points = even_points(apart);
    grid.build(points, 50);
    const Vec2 centre(320, 240);
    int within = 0;
    grid.visit_within(centre, grid.crowd_radius(centre, 40), [&](int, double) { ++within; });
    EXPECT_NEAR(within, 40, 14) << apart;  // nine cells hold from 50 to 2500 of them
  }
  const std::vector<Vec2> alone = {{10, 10}, {600, 400}};
  grid.build(alone, 50);
  EXPECT_GT(grid.crowd_radius({10, 10}, 40), 500);
}

void expect_same(const std::vector<Couple>& couples, const std::vector<Couple>& expected) {
  ASSERT_EQ(couples.size(), expected.size());
  for (std::size_t i = 0; i < couples.size(); ++i) {
    EXPECT_EQ(couples[i].cost, expected[i].cost);
    EXPECT_EQ(couples[i].a, expected[i].a);
    EXPECT_EQ(couples[i].b, expected[i].b);
  }
}

TEST(Couples, AreSortedFromACostBelowZeroOnAndIfOneIsFarHigher) {
  Random random(9);
  CoupleSorter sorter;
  for (const int count : {0, 1, 7, 500}) {
    // Some costs are equal, and one is far higher than all others.
    std::vector<Couple> couples;
    for (int i = 0; i < count; ++i) {
      const int a = static_cast<int>(random.uniform(0, 60)), b = 100 + i % 40;
      couples.push_back({std::round(random.uniform(-3, 5) * 20) / 20, a, b});
    }
    if (count > 0) couples.back().cost = 1e6;
    std::vector<Couple> expected = couples;
    std::sort(expected.begin(), expected.end());
    sorter.sort(couples, 1e6F, -3);
    expect_same(couples, expected);
  }
}

TEST(Couples, OfOneCostAreSortedByIndex) {
  CoupleSorter sorter;
  std::vector<Couple> couples = {{-2, 1, 5}, {-2, 0, 7}, {-2, 1, 4}};
  sorter.sort(couples, -2, -2);
  expect_same(couples, {{-2, 0, 7}, {-2, 1, 4}, {-2, 1, 5}});
}

TEST(PointGrid, FindsNothingNearestAmongNone) {
  PointGrid grid;
  std::vector<Neighbour> found(3);
  grid.build({}, 10);
  grid.nearest(
      {5, 5}, 100, 4, [](int) { return true; }, found);
  EXPECT_TRUE(found.empty());
}

TEST(Couples, AreSortedByCostThenByIndex) {
  Random random(6);
  CoupleSorter sorter;
  std::vector<Couple> couples;
  sorter.sort(couples, 7);
  for (int i = 0; i < 2000; ++i) {
    // Equal costs, both bounds, and costs of all sizes.
    const double cost = i % 3 == 0 ? i % 8 : 7 * std::exp(random.uniform(-80, 0));
    couples.emplace_back(cost, static_cast<int>(random.uniform(0, 9)), i);
  }
  std::vector<Couple> expected = couples;
  std::sort(expected.begin(), expected.end());
  sorter.sort(couples, 7);
  expect_same(couples, expected);
}

/// The machine's instruction and the plain sums count the same bits.

}  // namespace
}  // namespace lcs
