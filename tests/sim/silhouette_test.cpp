#include "sim/scene/silhouette.h"

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "tests/sim/model_of.h"
#include "tests/sim/support.h"

namespace lcs::sim {
namespace {

using Eigen::Vector3d;
using std::numbers::pi;

const Pinhole kCamera = Pinhole::from_fovy(640, 480, 60 * test::kDegree);
constexpr double kNear = 0.05;

/// Outline of a single MuJoCo geom, in the frame of its attributes.
ConvexParts geom(const std::string& attributes, const std::string& assets = "") {
  const std::string mjcf = "<mujoco><asset>" + assets + "</asset><worldbody><geom " + attributes +
                           "/></worldbody></mujoco>";
  Model model = test::model_of(mjcf);
  mj_kinematics(&model.m(), &model.d());
  const Pose T = model.geom_pose(0);
  return {(T.R * geom_hull(model.m(), 0)).colwise() + T.p};
}

Pose at(const Vector3d& p) {
  return {Eigen::Matrix3d::Identity(), p};
}

TEST(Silhouette, OfABoxIsThatOfItsNearFace) {
  // face of 0.4 m x 0.6 m at z = 2.9
  const double f = kCamera.focal_px;
  const double expected = f * 0.4 / 2.9 * f * 0.6 / 2.9;
  const double px =
      silhouette_px(kCamera, at({0, 0, 3}), geom("type='box' size='.2 .3 .1'"), kNear);
  // the border of 2 x (57 + 86) px may count by half a pixel
  EXPECT_NEAR(px, expected, 143);
}

TEST(Silhouette, OfASphereIsItsConesEllipse) {
  // a sphere of radius r at distance d on the axis is a disc of radius f r / sqrt(d^2 - r^2)
  const double radius_px = kCamera.focal_px * 0.5 / std::sqrt(9 - 0.25);
  const double px = silhouette_px(kCamera, at({0, 0, 3}), geom("type='sphere' size='.5'"), kNear);
  // hull of 48 meridians and 17 rings: within 1 %
  EXPECT_NEAR(px, pi * radius_px * radius_px, 0.01 * px);
}

TEST(Silhouette, OfRoundShapesSeenFromTheSide) {
  const Pose side{Eigen::AngleAxisd(pi / 2, Vector3d::UnitX()).toRotationMatrix(), {0, 0, 40}};
  const double scale = kCamera.focal_px / 40;  // far away: nearly parallel rays
  const double cylinder =
      silhouette_px(kCamera, side, geom("type='cylinder' size='.6 1.5'"), kNear);
  EXPECT_NEAR(cylinder, 1.2 * 3.0 * scale * scale, 0.05 * cylinder);
  const double capsule = silhouette_px(kCamera, side, geom("type='capsule' size='.6 1.5'"), kNear);
  EXPECT_NEAR(capsule, (1.2 * 3.0 + pi * 0.36) * scale * scale, 0.05 * capsule);
  const double ellipsoid =
      silhouette_px(kCamera, side, geom("type='ellipsoid' size='.6 .2 1.5'"), kNear);
  EXPECT_NEAR(ellipsoid, pi * 0.6 * 1.5 * scale * scale, 0.05 * ellipsoid);
}

TEST(Silhouette, OfAMeshIsThatOfItsHull) {
  const std::string tent =
      "<mesh name='tent' vertex='-1 0 0  1 0 0  0 1 0  -1 0 .01  1 0 .01  0 1 .01'/>";
  const double px =
      silhouette_px(kCamera, at({0, 0, 4}), geom("type='mesh' mesh='tent'", tent), kNear);
  const double scale = kCamera.focal_px / 4;
  EXPECT_NEAR(px, scale * scale, 0.02 * px);  // a triangle of 1 m^2
}

TEST(Silhouette, CountsWhatLiesOutsideOfTheImage) {
  const ConvexParts ball = geom("type='box' size='.2 .2 .001'");
  const double inside = silhouette_px(kCamera, at({0, 0, 3}), ball, kNear);
  // same depth, wholly beyond the right border: a flat face keeps its size
  EXPECT_NEAR(silhouette_px(kCamera, at({5, 0, 3}), ball, kNear), inside, 0.03 * inside);
}

TEST(Silhouette, CountsPartsThatOverlapOnce) {
  ConvexParts twice = geom("type='box' size='.2 .3 .1'");
  const double once = silhouette_px(kCamera, at({0.3, 0.1, 3}), twice, kNear);
  twice.push_back(twice[0]);
  EXPECT_EQ(silhouette_px(kCamera, at({0.3, 0.1, 3}), twice, kNear), once);
}

TEST(Silhouette, HasNoBoundsAcrossTheCameraPlane) {
  const ConvexParts box = geom("type='box' size='.2 .3 .5'");
  EXPECT_GT(silhouette_px(kCamera, at({0, 0, 0.6}), box, kNear), 0);
  EXPECT_EQ(silhouette_px(kCamera, at({0, 0, 0.5}), box, kNear), 0);
  EXPECT_EQ(silhouette_px(kCamera, at({0, 0, -3}), box, kNear), 0);
}

TEST(Silhouette, OfSomethingHugeIsMeasuredOnACoarserRaster) {
  const double f = kCamera.focal_px;
  const double px =
      silhouette_px(kCamera, at({0, 0, 0.2}), geom("type='box' size='2 3 .01'"), kNear);
  const double expected = f * 4 / 0.19 * f * 6 / 0.19;
  EXPECT_NEAR(px, expected, 0.01 * expected);
}

TEST(Silhouette, RefusesGeomsWithoutOne) {
  EXPECT_THROW(geom("type='plane' size='1 1 1'"), MujocoError);
}

}  // namespace
}  // namespace lcs::sim
