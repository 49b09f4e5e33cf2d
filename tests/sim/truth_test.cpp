// Labels of corners on synthetic frames, whose content is known exactly.

#include "sim/truth/truth.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector2d;
using Eigen::Vector2f;
using Eigen::Vector3d;

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr double kMinDepth = 0.5;
const Pinhole kCamera = Pinhole::from_fovy(640, 480, 60 * test::kDegree);

/// A wall at 4 m that fills the image and belongs to one of two objects; camera axes along W's.
FrameTruth wall(int object = 1) {
  FrameTruth t;
  t.depth_m = cv::Mat1f(480, 640, 4.F);
  t.object = cv::Mat1i(480, 640, object);
  t.now.T_WO.resize(3);
  t.next.T_WO.resize(3);
  return t;
}

CornerTruth label(const FrameTruth& t, const Vector2f& px, double min_depth_m = kMinDepth) {
  return label_corners(kCamera, t, std::vector{px}, min_depth_m).at(0);
}

TEST(LabelCorners, IsFixedOnABodyThatStays) {
  FrameTruth t = wall();
  t.next.T_WC.p = {0.1, 0, 0.2};
  const Vector2f corner(400, 100);
  const CornerTruth c = label(t, corner);
  EXPECT_EQ(c.label, Label::fixed);
  EXPECT_FALSE(c.radial);
  EXPECT_EQ(c.object, 1);
  EXPECT_EQ(c.depth_m, 4);
  // by hand: x = (u - c) / f * z, minus the camera's displacement
  const Vector3d x = kCamera.back_project(corner.cast<double>(), 4) - t.next.T_WC.p;
  const Vector2d expected = kCamera.project(x) - corner.cast<double>();
  EXPECT_NEAR((c.motion_px - expected).norm(), 0, 1e-9);
  EXPECT_EQ(c.motion_px, c.static_motion_px);
}

TEST(LabelCorners, FollowsABodyThatTurns) {
  FrameTruth t = wall();
  t.now.T_WO[1].p = {0, 0, 4};
  t.next.T_WO[1] = t.now.T_WO[1];
  t.next.T_WO[1].R = Eigen::AngleAxisd(0.1, Vector3d::UnitZ()).toRotationMatrix();
  const Vector2f corner(kCamera.centre_px.cast<float>() + Vector2f(100, 0));
  const CornerTruth c = label(t, corner);
  EXPECT_EQ(c.label, Label::rebel);
  EXPECT_NEAR((c.motion_px - 100 * Vector2d(std::cos(0.1) - 1, std::sin(0.1))).norm(), 0, 1e-4);
  EXPECT_NEAR(c.static_motion_px.norm(), 0, 1e-9);
}

TEST(LabelCorners, TellsARebelByOnePixelAgainstTheStaticMotion) {
  FrameTruth t = wall();
  t.next.T_WC.p = {0.2, 0, 0};
  const double px = 4 / kCamera.focal_px;  // moves the image of the wall by one pixel
  const Vector2f corner(300, 200);
  t.next.T_WO[1].p = {0, 0.999 * px, 0};
  EXPECT_EQ(label(t, corner).label, Label::indistinct);
  t.next.T_WO[1].p = {0, 1.001 * px, 0};
  EXPECT_EQ(label(t, corner).label, Label::rebel);
  // moving along with the camera: no motion in the image, yet a rebel
  t.next.T_WO[1].p = {0.2, 0, 0};
  const CornerTruth c = label(t, corner);
  EXPECT_EQ(c.label, Label::rebel);
  EXPECT_NEAR(c.motion_px.norm(), 0, 1e-9);
}

TEST(LabelCorners, CallsABodyAtRestThatCreepsFixed) {
  FrameTruth t = wall();
  t.next.T_WO[1].p = {1e-7, 0, 0};
  EXPECT_EQ(label(t, {300, 200}).label, Label::fixed);
}

TEST(LabelCorners, TheSettingIsALandmarkThatNeverMoves) {
  FrameTruth t = wall(0);
  t.next.T_WC.p = {0, 0, 0.5};
  EXPECT_EQ(label(t, {300, 200}).label, Label::fixed);
  EXPECT_EQ(label(t, {300, 200}).object, 0);
}

TEST(LabelCorners, SkyRoverAndPixelsOutsideAreNoLandmarks) {
  FrameTruth t = wall(-1);
  EXPECT_EQ(label(t, {300, 200}).label, Label::none) << "the rover itself";
  t.depth_m.setTo(kInfinity);
  EXPECT_EQ(label(t, {300, 200}).label, Label::none) << "sky";
  EXPECT_EQ(label(wall(), {-5, 20}).label, Label::none);
  EXPECT_EQ(label(wall(), {20, 900}).label, Label::none);
}

TEST(LabelCorners, BelongsToTheNearestOfTheNinePixels) {
  FrameTruth t = wall(0);
  t.object(201, 301) = 2;
  t.depth_m(201, 301) = 1.5F;
  for (const Vector2f& corner : {Vector2f(300, 200), Vector2f(302, 202), Vector2f(301, 201)}) {
    EXPECT_EQ(label(t, corner).object, 2);
    EXPECT_EQ(label(t, corner).depth_m, 1.5);
  }
  EXPECT_EQ(label(t, {299, 200}).object, 0) << "two pixels off";
  EXPECT_EQ(label(t, {300.4F, 199.6F}).object, 2) << "rounds to the pixel it lies in";
  // a part of the rover in front of a landmark hides it
  t.object(201, 301) = -1;
  EXPECT_EQ(label(t, {300, 200}).label, Label::none);
}

TEST(LabelCorners, AFixedCornerIsAtAnOutlineWhereFastsCircleReachesAMover) {
  FrameTruth t = wall(0);
  t.object(200, 303) = 1;  // of a body behind the wall's corner: the adjacent surface is the wall
  t.next.T_WO[1].p = {0, 0.2, 0};
  for (const Vector2f& corner : {Vector2f(300, 200), Vector2f(300, 199), Vector2f(301, 202)})
    EXPECT_TRUE(label(t, corner).outline) << corner.transpose();
  for (const Vector2f& corner : {Vector2f(299, 200), Vector2f(300, 198), Vector2f(301, 203)})
    EXPECT_FALSE(label(t, corner).outline) << corner.transpose();
  EXPECT_EQ(label(t, {300, 200}).label, Label::fixed);
  // not beside a static body, nor beside the sky
  t.object(200, 303) = 2;
  EXPECT_FALSE(label(t, {300, 200}).outline);
  t.object(200, 303) = -1;
  EXPECT_FALSE(label(t, {300, 200}).outline);
  // a corner on the mover itself is no outline of it, whether distinct or not
  EXPECT_FALSE(label(wall(1), {300, 200}).outline);
  // and at the border of the picture only pixels inside count
  FrameTruth border = wall(0);
  border.object(0, 0) = 1;
  border.next.T_WO[1].p = {0, 0.2, 0};
  EXPECT_TRUE(label(border, {2, 1}).outline);
}

TEST(LabelCorners, ABodyComingHeadOnIsRadial) {
  FrameTruth t = wall();
  t.next.T_WC.p = {0, 0, 0.2};
  t.next.T_WO[1].p = {0, 0, -1};  // as if a point at smaller depth approached
  const CornerTruth c = label(t, {500, 400});
  EXPECT_EQ(c.label, Label::rebel);
  EXPECT_TRUE(c.radial);
}

TEST(LabelCorners, ABodyComingFasterThanTheNearestDepthExplainsIsNotRadial) {
  FrameTruth t = wall();
  t.next.T_WC.p = {0, 0, 0.2};
  // moved to 4 - 0.2 - 2.6 = 1.2 m: magnified 3.3 times; a fixed point would need Z = 0.2 / (1 -
  // 1/3.33) = 0.286 m
  t.next.T_WO[1].p = {0, 0, -2.6};
  EXPECT_FALSE(label(t, {500, 400}).radial);
  EXPECT_TRUE(label(t, {500, 400}, 0.28).radial) << "with z_min below that depth";
}

TEST(LabelCorners, ABodyThatCrossesOrFleesIsNotRadial) {
  FrameTruth t = wall();
  t.next.T_WC.p = {0, 0, 0.2};
  t.next.T_WO[1].p = {0, 0.2, 0};
  EXPECT_FALSE(label(t, {500, 240}).radial) << "across its static segment";
  t.next.T_WO[1].p = {0, 0, 0.5};
  const CornerTruth fleeing = label(t, {600, 400});
  EXPECT_EQ(fleeing.label, Label::rebel);
  EXPECT_FALSE(fleeing.radial) << "beyond the ideal point at infinity";
}

TEST(LabelCorners, TheStaticSegmentEndsInTheIdealPointUnderRotation) {
  FrameTruth t = wall();
  t.next.T_WC.R = Eigen::AngleAxisd(0.05, Vector3d::UnitY()).toRotationMatrix();
  t.next.T_WC.p = {0, 0, 0.2};
  // practically to infinity
  const Vector2f corner(420, 300);
  const Vector3d p = kCamera.back_project(corner.cast<double>(), 4);
  t.next.T_WO[1].p = 1000 * p - p;
  const CornerTruth c = label(t, corner);
  EXPECT_EQ(c.label, Label::rebel);
  EXPECT_TRUE(c.radial);
  const Vector2d rotation_only =
      kCamera.project(t.next.T_WC.R.transpose() * p) - corner.cast<double>();
  EXPECT_NEAR((c.motion_px - rotation_only).norm(), 0, 0.1);
}

TEST(LabelCorners, APointBehindTheCameraAtTheNextFrameHasNoMotion) {
  FrameTruth t = wall();
  t.next.T_WC.p = {0, 0, 5};
  const CornerTruth passed = label(t, {300, 200});
  EXPECT_EQ(passed.label, Label::fixed);
  EXPECT_TRUE(std::isnan(passed.motion_px.x()) && std::isnan(passed.static_motion_px.y()));

  t = wall();
  t.next.T_WO[1].p = {0, 0, -5};
  const CornerTruth flown_past = label(t, {300, 200});
  EXPECT_EQ(flown_past.label, Label::indistinct);
  EXPECT_TRUE(std::isnan(flown_past.motion_px.x()));
  EXPECT_FALSE(std::isnan(flown_past.static_motion_px.x()));
}

// The part of the static segment that the camera passes is cut off, the rest remains.
TEST(LabelCorners, TheStaticSegmentOfACameraThatDrivesFarIsARay) {
  FrameTruth t = wall();
  t.next.T_WC.p = {0, 0, 2};        // points nearer than 2 m are passed
  t.next.T_WO[1].p = {0, 0, -1.5};  // magnified 4 / 0.5 = 8 times; a fixed point at 2.29 m would be
  const CornerTruth c = label(t, {340, 250});
  EXPECT_EQ(c.label, Label::rebel);
  EXPECT_TRUE(c.radial);
}

TEST(LabelCorners, GivesOneLabelForEachCornerInOrder) {
  FrameTruth t = wall();
  t.object(cv::Rect(320, 0, 320, 480)).setTo(2);
  const std::vector<Vector2f> corners = {{10, 10}, {600, 10}, {20, 400}};
  const auto labels = label_corners(kCamera, t, corners, kMinDepth);
  ASSERT_EQ(labels.size(), 3u);
  EXPECT_EQ(labels[0].object, 1);
  EXPECT_EQ(labels[1].object, 2);
  EXPECT_EQ(labels[2].object, 1);
  EXPECT_TRUE(label_corners(kCamera, t, {}, kMinDepth).empty());
}

TEST(LabelCorners, RefusesANearestDepthThatIsNone) {
  EXPECT_THROW(label(wall(), {1, 1}, 0), std::invalid_argument);
  EXPECT_THROW(label(wall(), {1, 1}, -1), std::invalid_argument);
  EXPECT_THROW(label(wall(), {1, 1}, std::nan("")), std::invalid_argument);
}

TEST(ModalBoxes, AreHalfOpenAndCountPixels) {
  cv::Mat1i ids(10, 20, 0);
  ids(2, 3) = ids(2, 4) = ids(5, 7) = 2;
  ids.row(9).setTo(-1);
  const auto boxes = modal_boxes(ids, 3);
  ASSERT_EQ(boxes.size(), 3u);
  EXPECT_EQ(boxes[0].visible_px, 0);
  EXPECT_EQ(boxes[1].object, 2);
  EXPECT_EQ(boxes[1].left, 3);
  EXPECT_EQ(boxes[1].right, 8);
  EXPECT_EQ(boxes[1].top, 2);
  EXPECT_EQ(boxes[1].bottom, 6);
  EXPECT_EQ(boxes[1].visible_px, 3);
}

TEST(Pinhole, ProjectsAndBackProjects) {
  EXPECT_NEAR(kCamera.focal_px, 240 / std::tan(30 * test::kDegree), 1e-12);
  EXPECT_EQ(kCamera.centre_px, Vector2d(319.5, 239.5));
  const Vector2d px(12.25, 477);
  EXPECT_NEAR((kCamera.project(kCamera.back_project(px, 7)) - px).norm(), 0, 1e-12);
  EXPECT_EQ(kCamera.back_project(px, 7).z(), 7);
}

TEST(Pinhole, RefusesWhatIsNoCamera) {
  EXPECT_THROW(Pinhole::from_fovy(0, 480, 1), std::invalid_argument);
  EXPECT_THROW(Pinhole::from_fovy(640, -1, 1), std::invalid_argument);
  EXPECT_THROW(Pinhole::from_fovy(640, 480, 0), std::invalid_argument);
  EXPECT_THROW(Pinhole::from_fovy(640, 480, std::numbers::pi), std::invalid_argument);
  EXPECT_THROW(Pinhole::from_fovy(640, 480, std::nan("")), std::invalid_argument);
}

}  // namespace
}  // namespace lcs::sim
