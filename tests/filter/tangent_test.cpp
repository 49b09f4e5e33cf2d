#include "filter/paper/paper_squares.h"

#include <gtest/gtest.h>

#include "filter/kinematics/geometry.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using namespace paper;

using testing::Random;

Extent random_extent(Random& random) {
  return {{random.uniform(0, 640), random.uniform(0, 480)},
          {random.uniform(5, 120), random.uniform(5, 120)}};
}

double ellipse_value(const Extent& e, const Vec2& x) {
  return (x - e.location).cwiseQuotient(e.half_size).squaredNorm();
}

TEST(Tangents, PointsLieOnTheEllipseAndTheirLinesTouchIt) {
  Random random(1);
  int tried = 0;
  for (int i = 0; i < 500; ++i) {
    const Extent extent = random_extent(random);
    const Vec2 origin(random.uniform(-200, 840), random.uniform(-200, 680));
    const auto points = tangent_points(extent, origin);
    if (ellipse_value(extent, origin) <= 1) {
      EXPECT_FALSE(points);
      continue;
    }
    ASSERT_TRUE(points);
    ++tried;
    for (const Vec2& touch : {points->first, points->second}) {
      EXPECT_NEAR(ellipse_value(extent, touch), 1, 1e-9);
      for (const double beside : {-0.05, 0.05}) {  // any other point on the line is outside
        EXPECT_GT(ellipse_value(extent, touch + beside * (touch - origin)), 1);
      }
    }
  }
  EXPECT_GT(tried, 300);
}

TEST(Tangents, ConstructionIsTheHomothetyAboutTheOriginWhereDefined) {
  Random random(2);
  int defined = 0;
  for (int i = 0; i < 1000; ++i) {
    const Extent extent = random_extent(random);
    const Vec2 origin(random.uniform(-200, 840), random.uniform(-200, 680));
    const double travelled = random.uniform(-0.3, 0.5) * (extent.location - origin).norm();
    const auto predicted = predict_by_tangents(extent, origin, travelled);
    if (!predicted) continue;
    ++defined;
    const Extent expected = predict_by_homothety(extent, origin, travelled);
    EXPECT_TRUE(predicted->location.isApprox(expected.location, 1e-9));
    EXPECT_TRUE(predicted->half_size.isApprox(expected.half_size, 1e-6));
  }
  EXPECT_GT(defined, 700);
}

TEST(Tangents, HoldForAWideEllipseCloseToTheOrigin) {
  // |O L_t| > |O L|: the printed second case of d_r, which would not be a homothety.
  const Extent extent{{320, 300}, {150, 20}};
  const Vec2 origin(300, 240);
  const auto points = tangent_points(extent, origin);
  ASSERT_TRUE(points);
  ASSERT_GT((points->first - origin).norm(), (extent.location - origin).norm());
  const auto predicted = predict_by_tangents(extent, origin, 10);
  ASSERT_TRUE(predicted);
  EXPECT_TRUE(
      predicted->half_size.isApprox(predict_by_homothety(extent, origin, 10).half_size, 1e-6));
}

TEST(Tangents, AreVoidWhenTheOriginIsInsideAndTheHomothetyStillHolds) {
  const Extent extent{{320, 240}, {100, 80}};
  EXPECT_FALSE(predict_by_tangents(extent, {330, 250}, 5));
  const double distance = std::hypot(10, 10);
  const Extent grown = predict_by_homothety(extent, {330, 250}, 0.1 * distance);
  EXPECT_TRUE(grown.half_size.isApprox(Vec2(110, 88)));
}

TEST(Tangents, AreSingularWhenATangentIsParallelToAnAxis) {
  // Both tangents from straight above touch symmetrically. From (r, 0) off, one tangent of a circle
  // is vertical, and only the other one is usable.
  const Extent circle{{320, 240}, {50, 50}};
  const Vec2 origin(370, 0);  // the line x = 370 touches at (370, 240)
  const auto predicted = predict_by_tangents(circle, origin, 12);
  ASSERT_TRUE(predicted);
  EXPECT_TRUE(
      predicted->half_size.isApprox(predict_by_homothety(circle, origin, 12).half_size, 1e-6));
}

TEST(Tangents, ASquareWithoutAreaHasNone) {
  EXPECT_FALSE(tangent_points({{10, 10}, {0, 5}}, {100, 100}));
  EXPECT_FALSE(predict_by_tangents({{10, 10}, {0, 0}}, {100, 100}, 1));
}

TEST(Tangents, ASquareOnItsOriginStays) {
  const Extent extent{{320, 240}, {30, 20}};
  EXPECT_TRUE(predict_by_homothety(extent, {320, 240}, 7).location.isApprox(extent.location));
}

/// In reverse a square nears its origin; a step beyond the origin ends there.
TEST(Tangents, NothingIsPredictedBeyondTheOrigin) {
  const Extent extent{{400, 300}, {30, 20}};
  const Vec2 origin(320, 240);  // 100 px off
  EXPECT_TRUE(predict_by_tangents(extent, origin, -99));
  EXPECT_FALSE(predict_by_tangents(extent, origin, -101));
  const Extent gone = predict_by_homothety(extent, origin, -101);
  EXPECT_EQ(gone.location, origin);
  EXPECT_TRUE(gone.half_size.isZero());
}

}  // namespace
}  // namespace lcs
