#include "tools/scoring/score_squares.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "filter/squares/convex_hull.h"
#include "tests/tools/recordings.h"

namespace lcs::scoring {
namespace {

constexpr int kSide = 40;

/// Reference: pixel by pixel.
struct Oracle {
  cv::Mat1b pixels = cv::Mat1b(kSide, kSide, uchar{0});

  template <typename Inside>
  explicit Oracle(Inside&& inside) {
    for (int y = 0; y < kSide; ++y) {
      for (int x = 0; x < kSide; ++x) pixels(y, x) = inside(Vec2(x, y)) ? 1 : 0;
    }
  }
};

/// The pixels that `paint` sets in a picture.
template <typename... What>
cv::Mat1b painted(const What&... what) {
  cv::Mat1b picture(kSide, kSide, uchar{0});
  paint(what..., picture);
  return picture;
}

/// Whether the region has exactly the pixels of the reference.
bool equals(const cv::Mat1b& region, const Oracle& oracle) {
  return cv::countNonZero((region != 0) != (oracle.pixels != 0)) == 0;
}

bool is_in(const Outline& outline, const Vec2& x) {
  const auto v = outline.vertices();
  for (std::size_t i = 0; i < v.size(); ++i) {
    const Vec2 side = v[(i + 1) % v.size()] - v[i], to = x - v[i];
    if (side.x() * to.y() - side.y() * to.x() < -1e-6) return false;
  }
  return true;
}

class Regions : public testing::Test {
 protected:
  double number(double least, double most) {
    return std::uniform_real_distribution<>(least, most)(random_);
  }
  /// Half of the outlines have whole pixels as vertices, like corners.
  Outline outline(int points) {
    const bool whole = random_() % 2 == 0;
    ConvexHull hull;
    for (int i = 0; i < points; ++i) {
      const Vec2 point(number(2, kSide - 3), number(2, kSide - 3));
      hull.add(whole ? Vec2(point.array().round()) : point);
    }
    return hull.outline();
  }
  cv::Mat1b picture() {
    cv::Mat1b picture(kSide, kSide, uchar{0});
    for (int i = 0; i < 6; ++i) {
      const cv::Point corner(static_cast<int>(number(0, 30)), static_cast<int>(number(0, 30)));
      picture(cv::Rect(corner, cv::Size(1 + i, 9 - i))) = i == 3 ? 0 : 255;
    }
    return picture;
  }

  std::mt19937 random_{1};
};

TEST_F(Regions, OfOutlinesBoxesAndMasksAreThoseFoundPixelByPixel) {
  for (int i = 0; i < 400; ++i) {
    const Outline one = outline(3 + i % 12);
    const cv::Mat1b picture = this->picture();
    const recording::Box box{Vec2(number(0, 15), number(0, 15)),
                             Vec2(number(15, 39), number(15, 39))};
    if (one.count < 3) continue;
    EXPECT_TRUE(equals(painted(one), Oracle([&](const Vec2& x) { return is_in(one, x); })));
    EXPECT_TRUE(equals(painted(box), Oracle([&](const Vec2& x) { return box.contains(x); })));
    EXPECT_TRUE(equals(painted(sim::mask_of(picture)), Oracle([&](const Vec2& x) {
                         return picture(static_cast<int>(x.y()), static_cast<int>(x.x())) != 0;
                       })));
  }
}

/// Corners lie on an object's outermost pixels, whose centres form the rim of the outline.
TEST_F(Regions, AnOutlineThroughTheCornersOfABoxOfPixelsCoversAllOfThem) {
  ConvexHull hull;
  for (const Vec2& corner : {Vec2(10, 20), Vec2(19, 20), Vec2(19, 24), Vec2(10, 24)}) {
    hull.add(corner + Vec2(1e-9, -1e-9));
  }
  EXPECT_EQ(cv::countNonZero(painted(hull.outline())), 50);
}

TEST_F(Regions, AreNoneOfNothingAndEndWithThePictureHoweverFarTheyReach) {
  constexpr int kAll = kSide * kSide;
  EXPECT_EQ(cv::countNonZero(painted(Outline{})), 0);
  EXPECT_EQ(cv::countNonZero(painted(recording::Box{Vec2(-1e300, -1e300), Vec2(1e300, 1e300)})),
            kAll);
  EXPECT_EQ(cv::countNonZero(painted(recording::Box{Vec2(1e6, 0), Vec2(1e7, 10)})), 0);
  EXPECT_EQ(cv::countNonZero(painted(sim::Mask{cv::Rect(-3, 38, 4, 3), {0, 12}})), 2);
  Outline wide;
  wide.count = 3;
  wide.places[0] = {-1e300, 0};
  wide.places[1] = {1e300, -1e300};
  wide.places[2] = {1e300, 1e300};
  EXPECT_EQ(cv::countNonZero(painted(wide)), kAll);
}

TEST_F(Regions, OfASquareAreItsMaskElseItsOutlineElseItsBox) {
  test::FrameMaker maker(0);
  Square square = maker.square(3, {10, 10, 20, 20}).record().layers.squares[0];
  EXPECT_EQ(cv::countNonZero(painted(square, recording::SquareMasks{})), 100);
  ConvexHull hull;
  for (const Vec2& corner : {Vec2(10, 10), Vec2(19, 10), Vec2(10, 19)}) hull.add(corner);
  square.outline = hull.outline();
  EXPECT_EQ(cv::countNonZero(painted(square, recording::SquareMasks{})), 55);
  const recording::SquareMasks masks{{3, {cv::Rect(10, 10, 2, 3), {0, 4, 1, 1}}}};
  EXPECT_EQ(cv::countNonZero(painted(square, masks)), 5);
}

}  // namespace
}  // namespace lcs::scoring
