/// What is seen in gaps, in pictures that are drawn point by point from a texture.
#include "filter/detect/gap_picture.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "tests/filter/world.h"

namespace lcs {
namespace {

const Intrinsics kCamera{200, {79.5, 59.5}, 160, 120};
constexpr double kSpeed_mps = 1, kDt_s = 0.1, kHeight_m = 0.5, kBody_m = 1.5;

enum class Below { ground, body, plain };

/// A camera drives ahead above a ground; what is below the horizon is that ground, or a static wall
/// at the depth of the body, or without a contour.
cv::Mat1b picture(Below below, double driven_m) {
  cv::Mat1b grey(kCamera.height_px, kCamera.width_px, uchar{90});
  if (below == Below::plain) return grey;
  for (int r = 62; r < grey.rows; ++r) {
    for (int c = 0; c < grey.cols; ++c) {
      const Vec2 h = (Vec2(c, r) - kCamera.centre_px) / kCamera.focal_px;
      const double depth_m = below == Below::ground ? kHeight_m / h.y() : kBody_m - driven_m;
      const double x = h.x() * depth_m,
                   y = below == Below::ground ? depth_m + driven_m : h.y() * depth_m;
      grey(r, c) = static_cast<uchar>(120 + 45 * std::sin(70 * x) + 45 * std::cos(55 * y + 3 * x));
    }
  }
  return grey;
}

EgoMotion ahead() {
  EgoMotion motion = testing::steady_motion({0, 0, kSpeed_mps}, {0, 0, 0}, kDt_s);
  motion.ground = Ground{.up_C = {0, -1, 0}, .height_m = kHeight_m};
  return motion;
}

/// The gap in the fourth frame.
Gap gap() {
  Gap gap;
  gap.place_px = {50, 80};
  gap.columns = 50;
  gap.rows = 25;
  gap.inverse_depth_pm = 1 / (kBody_m - 3 * kSpeed_mps * kDt_s);
  return gap;
}

std::optional<double> evidence(Below below, const Gap& gap, int frames = 4) {
  GapPicture pictures(kCamera);
  for (int k = 0; k < frames; ++k) {
    EgoMotion motion = ahead();
    if (k == 0) motion.dt_s = 0;
    pictures.show(picture(below, k * kSpeed_mps * kDt_s));
    pictures.begin(motion);
  }
  return pictures.evidence(gap);
}

TEST(GapPicture, TellsTheGroundFromTheBody) {
  EXPECT_GT(evidence(Below::ground, gap()).value(), 1);
  EXPECT_LT(evidence(Below::body, gap()).value(), -1);
}

TEST(GapPicture, TakesAGapWithoutAContourForNoBody) {
  EXPECT_DOUBLE_EQ(evidence(Below::plain, gap()).value(), 3);
}

TEST(GapPicture, KnowsNothingInTheFirstFrameOrOfTooFewRows) {
  EXPECT_FALSE(evidence(Below::ground, gap(), 1));
  Gap low = gap();
  low.rows = 2;
  EXPECT_FALSE(evidence(Below::ground, low));
  Gap outside = gap();
  outside.place_px.x() = 500;
  EXPECT_FALSE(evidence(Below::ground, outside));
}

TEST(GapPicture, ForgetsEarlierPicturesWhereNoTimeHasPassed) {
  GapPicture pictures(kCamera);
  for (int k = 0; k < 4; ++k) {
    pictures.show(picture(Below::ground, 0.1 * k));
    pictures.begin(ahead());
  }
  EXPECT_TRUE(pictures.evidence(gap()));
  EgoMotion still = ahead();
  still.dt_s = 0;
  pictures.show(picture(Below::ground, 0.3));
  pictures.begin(still);
  EXPECT_FALSE(pictures.evidence(gap()));
}

TEST(GapPicture, IsTheSameForARolledCamera) {
  // The camera rolled by a quarter turn: its picture is the upright one, turned.
  const Intrinsics rolled{200, {59.5, 79.5}, 120, 160};
  GapPicture pictures(rolled);
  for (int k = 0; k < 4; ++k) {
    EgoMotion motion = ahead();
    if (k == 0) motion.dt_s = 0;
    motion.ground->up_C = {1, 0, 0};
    cv::Mat1b turned;
    cv::rotate(picture(Below::ground, 0.1 * k), turned, cv::ROTATE_90_CLOCKWISE);
    pictures.show(turned);
    pictures.begin(motion);
  }
  Gap turned = gap();
  turned.across = Vec2::UnitY();
  turned.place_px = {119 - gap().place_px.y(), gap().place_px.x()};
  EXPECT_NEAR(pictures.evidence(turned).value(), evidence(Below::ground, gap()).value(), 0.05);
}

TEST(GapPicture, RefusesAPictureOfAnotherSize) {
  GapPicture pictures(kCamera);
  EXPECT_THROW(pictures.show(cv::Mat1b(10, 10)), std::invalid_argument);
}

}  // namespace
}  // namespace lcs
