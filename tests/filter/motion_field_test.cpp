#include "filter/kinematics/motion_field.h"

#include <gtest/gtest.h>

#include "filter/kinematics/geometry.h"
#include "tests/filter/world.h"

namespace lcs {
namespace {

using Eigen::Vector3d;
using testing::back_project;
using testing::project;
using testing::Random;
using testing::steady_motion;
using testing::vga;

Vec2 random_pixel(Random& random) {
  return {random.uniform(0, 639), random.uniform(0, 479)};
}

TEST(MotionField, HomographyIsTheExactRotationWhateverTheDepth) {
  Random random(1);
  for (int i = 0; i < 200; ++i) {
    const EgoMotion motion = steady_motion(Vector3d::Zero(), random.vector(2), 0.1);
    const MotionField field(vga(), motion, {});
    const Vec2 x = random_pixel(random);
    const Vector3d turned = motion.R_cur_prev * back_project(vga(), x, random.uniform(0.5, 50));
    EXPECT_TRUE(field.rotated(x).isApprox(project(vga(), turned), 1e-9));
  }
}

/// The error of a first-order model is quadratic: half the angle, a quarter of the error.
TEST(MotionField, FirstOrderRotationErrsByTheSquareOfTheAngle) {
  Random random(2);
  FieldParameters first_order;
  first_order.rotation = RotationModel::first_order;
  for (int i = 0; i < 50; ++i) {
    const Vector3d axis = random.vector(1).normalized();
    const Vec2 x = random_pixel(random);
    const auto error = [&](double angle) {
      const EgoMotion motion = steady_motion(Vector3d::Zero(), axis * angle, 1);
      return (MotionField(vga(), motion, first_order).rotated(x) -
              MotionField(vga(), motion, {}).rotated(x))
          .norm();
    };
    const double full = error(0.01), half = error(0.005);
    EXPECT_LT(
        full,
        0.1);  // 0.57 degrees: second order terms are below f * angle^2 = 0.04 px and more off-axis
    if (full > 1e-4) {
      EXPECT_NEAR(full / half, 4, 0.3);
    }
  }
}

TEST(MotionField, TranslationIsExactForTheTrueDepth) {
  Random random(3);
  FieldParameters parameters;
  for (int i = 0; i < 200; ++i) {
    const EgoMotion motion = steady_motion(random.vector(1), Vector3d::Zero(), 0.1);
    const MotionField field(vga(), motion, parameters);
    const Vector3d before = back_project(vga(), random_pixel(random), random.uniform(1, 20));
    const Vector3d now = before - motion.v_C_mps * motion.dt_s;
    const double ratio = parameters.reference_depth_m / now.z();
    EXPECT_TRUE(
        field.translated(project(vga(), before), ratio).isApprox(project(vga(), now), 1e-9));
    EXPECT_NEAR(field.advanced_ratio(parameters.reference_depth_m / before.z()), ratio, 1e-9);
    EXPECT_NEAR(field.expansion(ratio), before.z() / now.z(), 1e-9);
  }
}

TEST(MotionField, EarlierUndoesTheTranslation) {
  Random random(4);
  FieldParameters parameters;
  for (int i = 0; i < 200; ++i) {
    const Vector3d displacement = random.vector(0.3);
    const EgoMotion motion = steady_motion(displacement / 0.1, Vector3d::Zero(), 0.1);
    const MotionField field(vga(), motion, parameters);
    const Vector3d now = back_project(vga(), random_pixel(random), random.uniform(1, 20));
    const Vec2 before = project(vga(), now + displacement);
    const double ratio = parameters.reference_depth_m / now.z();
    const Vec2 x = project(vga(), now);
    EXPECT_TRUE(field.earlier(x, ratio, displacement).isApprox(before, 1e-9));
  }
}

TEST(MotionField, TheGroundHasTheDepthOfItsPlane) {
  Random random(9);
  for (int i = 0; i < 100; ++i) {
    const Vector3d up = testing::rotation(random.vector(0.2)) * Vector3d(0, -1, 0);
    EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
    motion.ground = Ground{.up_C = up, .height_m = random.uniform(0.2, 2)};
    const MotionField field(vga(), motion, {});
    // A point of the plane: up . X = -height.
    Vector3d x_C(random.uniform(-1, 1), 0, random.uniform(1, 9));
    x_C.y() = (-motion.ground->height_m - up.x() * x_C.x() - up.z() * x_C.z()) / up.y();
    const Vec2 x = project(vga(), x_C);
    ASSERT_TRUE(field.ground_ratio(x));
    EXPECT_NEAR(*field.ground_ratio(x), field.reference_depth_m() / x_C.z(), 1e-9);
    EXPECT_LT(*field.ground_ratio(project(vga(), x_C + 2 * motion.ground->height_m * up)), 0)
        << "above the horizon";
  }
}

TEST(MotionField, HasAGroundWhereTheMotionHasOne) {
  EgoMotion motion = steady_motion({0, 0, 0.3}, Vector3d::Zero(), 0.1);
  EXPECT_FALSE(MotionField(vga(), motion, {}).ground_ratio({320, 400}));
  motion.ground = Ground{.height_m = 0.5};
  EXPECT_GT(MotionField(vga(), motion, {}).ground_ratio({320, 400}), 0);
}

TEST(MotionField, FlowLeavesTheFocusOfExpansionWhereverItIs) {
  Random random(5);
  for (int i = 0; i < 100; ++i) {
    Vector3d v = random.vector(1);
    v.z() = random.uniform(0.2, 1);
    const MotionField field(vga(), steady_motion(v, Vector3d::Zero(), 0.1), {});
    ASSERT_TRUE(field.foe());
    const Vec2 x = random_pixel(random);
    EXPECT_NEAR(wrap_angle(angle_of(field.direction(x)) - angle_of(x - *field.foe())), 0, 1e-9);
  }
}

TEST(MotionField, ReverseFlowsTowardsTheFocus) {
  const MotionField field(vga(), steady_motion({0, 0, -1}, Vector3d::Zero(), 0.1), {});
  const Vec2 x(100, 100);
  ASSERT_TRUE(field.foe());
  EXPECT_LT(field.direction(x).dot(x - *field.foe()), 0);
  EXPECT_LT((field.translated(x, 1) - *field.foe()).norm(), (x - *field.foe()).norm());
}

TEST(MotionField, SidewaysFlowsInParallel) {
  const MotionField field(vga(), steady_motion({0.5, 0, 0}, Vector3d::Zero(), 0.1), {});
  EXPECT_FALSE(field.foe());
  for (const Vec2& x : {Vec2(10, 10), Vec2(600, 20), Vec2(320, 470)}) {
    EXPECT_TRUE(field.direction(x).isApprox(Vec2(-1, 0)));
    // Directions about the stand-in for the focus equal those of the flow.
    EXPECT_TRUE((x - field.origin(x)).normalized().isApprox(Vec2(-1, 0)));
  }
}

TEST(MotionField, StandingStillHasNoFlow) {
  const MotionField field(vga(), steady_motion({0, 0, 1e-4}, Vector3d::Zero(), 0.1), {});
  EXPECT_FALSE(field.moving());
  EXPECT_TRUE(field.direction({100, 100}).isZero());
  EXPECT_TRUE(field.translated({100, 100}, 5).isApprox(Vec2(100, 100)));
}

TEST(MotionField, CorrectedIsTheFieldOfTheOtherMotion) {
  Random random(8);
  const Vector3d v(0.1, -0.2, 0.8), w(0.1, 0.2, -0.1), more(0.02, 0.01, -0.03);
  const double dt = 0.1;
  const Vector3d turn(1e-3, -2e-3, 5e-4);
  const MotionField told(vga(), steady_motion(v, w, dt), {});
  // Small turns add up, except for second-order terms: 1e-5 rad, times the focal length.
  const MotionField other(vga(), steady_motion(v + more, w + turn / dt, dt), {});
  const MotionField corrected = told.corrected(turn, more);
  for (int i = 0; i < 50; ++i) {
    const Vec2 x = random_pixel(random);
    EXPECT_LT((corrected.rotated(x) - other.rotated(x)).norm(), 0.03);
    EXPECT_TRUE(corrected.direction(x).isApprox(other.direction(x), 1e-9));
    EXPECT_NEAR(corrected.reference_speed(x), other.reference_speed(x), 1e-9);
  }
  const MotionField still(vga(), EgoMotion{}, {});
  EXPECT_TRUE(still.corrected(turn, more).direction({9, 9}).isZero()) << "no time passed";
}

TEST(MotionField, SpeedOverReferenceSpeedIsTheSameAtOneDepthEverywhere) {
  Random random(6);
  FieldParameters parameters;
  const double depth = 5, dt = 0.05;
  const Vector3d v(0.1, -0.2, 0.8);
  const MotionField field(vga(), steady_motion(v, Vector3d::Zero(), dt), parameters);
  for (int i = 0; i < 100; ++i) {
    const Vec2 x = random_pixel(random);
    const Vector3d now = back_project(vga(), x, depth + v.z() * dt) - v * dt;  // at `depth` now
    const double speed = (project(vga(), now) - x).norm() / dt;
    EXPECT_NEAR(speed / field.reference_speed(x), parameters.reference_depth_m / depth, 1e-9);
  }
}

TEST(MotionField, PointPassedWithinTheIntervalGetsTheLargestRatio) {
  FieldParameters parameters;
  const MotionField field(vga(), steady_motion({0, 0, 10}, Vector3d::Zero(), 1), parameters);
  EXPECT_DOUBLE_EQ(field.advanced_ratio(parameters.reference_depth_m / 5), 2 * field.max_ratio());
}

}  // namespace
}  // namespace lcs
