/// Effect of the camera's own motion on all state that is kept from frame to frame.
#include <gtest/gtest.h>

#include "filter/kinematics/geometry.h"
#include "tests/filter/paper_steps.h"

namespace lcs {
namespace {

using namespace paper;
using testing::AllLayers;
using testing::CircleSteps;
using testing::EdgeSteps;
using testing::SquareSteps;

using Eigen::Vector3d;
using testing::back_project;
using testing::project;
using testing::Random;
using testing::steady_motion;
using testing::vga;

Vec2 middle_pixel(Random& random) {
  return {random.uniform(150, 490), random.uniform(120, 360)};
}

/// An item at a random place that came from `origin` in a straight line.
template <typename Item>
Item from_origin(Random& random) {
  Item item;
  item.location = middle_pixel(random);
  item.origin = middle_pixel(random);
  item.angle = angle_of(item.location - item.origin);
  return item;
}

Circle rebel_circle(Random& random) {
  auto circle = from_origin<Circle>(random);
  circle.rebel = true;
  return circle;
}

Square rebel_square(Random& random) {
  auto square = from_origin<Square>(random);
  square.rebel_circles = 1;
  square.half_size = {20, 10};
  return square;
}

void predict_all(AllLayers& layers, const MotionField& field) {
  EdgeSteps().predict(layers, field);
  CircleSteps().predict(layers, field);
  SquareSteps().predict(layers, field);
}

struct Rotation : ::testing::TestWithParam<RotationModel> {
  FieldParameters parameters() const {
    FieldParameters p;
    p.rotation = GetParam();
    return p;
  }
  MotionField turning(const Vector3d& w) const {
    return {vga(), steady_motion(Vector3d::Zero(), w, 0.1), parameters()};
  }
};
INSTANTIATE_TEST_SUITE_P(Models, Rotation,
                         ::testing::Values(RotationModel::first_order, RotationModel::homography,
                                           RotationModel::as_printed),
                         [](const auto& model) {
                           return model.param == RotationModel::homography    ? "homography"
                                  : model.param == RotationModel::first_order ? "first_order"
                                                                              : "as_printed";
                         });

TEST_P(Rotation, MovesEveryStoredLocationAndEveryOriginOfItsOwn) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const MotionField field = turning(random.vector(1));
    AllLayers before;
    before.normal_edges = {from_origin<Edge>(random)};
    before.rebel_edges = {from_origin<Edge>(random)};
    before.normal_circles = {from_origin<Circle>(random)};
    before.rebel_circles = {rebel_circle(random)};
    before.squares = {from_origin<Square>(random), rebel_square(random)};
    before.squares[0].half_size = {20, 10};
    before.chains = {{.sightings = {middle_pixel(random), middle_pixel(random)}, .count = 2}};
    AllLayers after = before;
    predict_all(after, field);

    EXPECT_EQ(after.normal_edges[0].predicted, field.rotated(before.normal_edges[0].location));
    EXPECT_EQ(after.rebel_edges[0].predicted, field.rotated(before.rebel_edges[0].location));
    EXPECT_EQ(after.rebel_edges[0].origin, field.rotated(before.rebel_edges[0].origin));
    EXPECT_EQ(after.normal_circles[0].location, field.rotated(before.normal_circles[0].location));
    EXPECT_EQ(after.rebel_circles[0].location, field.rotated(before.rebel_circles[0].location));
    EXPECT_EQ(after.rebel_circles[0].origin, field.rotated(before.rebel_circles[0].origin));
    for (int s = 0; s < 2; ++s) {
      EXPECT_EQ(after.squares[s].location, field.rotated(before.squares[s].location));
    }
    EXPECT_EQ(after.squares[1].origin, field.rotated(before.squares[1].origin));
    for (int s = 0; s < 2; ++s) {
      EXPECT_EQ(after.chains[0].sightings[s], field.rotated(before.chains[0].sightings[s]));
    }
  }
}

/// beta(k-1) is recomputed from L(k-1) and O(k-1) after these have been moved.
TEST_P(Rotation, TurnsTheDirectionsOfRebels) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const MotionField field = turning(random.vector(3));  // up to 17 degrees in the interval
    AllLayers before;
    before.rebel_edges = {from_origin<Edge>(random)};
    before.rebel_circles = {rebel_circle(random)};
    before.squares = {rebel_square(random)};
    AllLayers after = before;
    predict_all(after, field);
    const auto turned = [&](const auto& item) {
      return angle_of(field.rotated(item.location) - field.rotated(item.origin));
    };
    EXPECT_NEAR(angle_between(after.rebel_edges[0].angle, turned(before.rebel_edges[0])), 0, 1e-9);
    EXPECT_NEAR(angle_between(after.rebel_circles[0].angle, turned(before.rebel_circles[0])), 0,
                1e-9);
    EXPECT_NEAR(angle_between(after.squares[0].angle, turned(before.squares[0])), 0, 1e-9);
  }
}

TEST_P(Rotation, CarriesARebelOnInItsTurnedDirection) {
  // A roll of 90 degrees within the frame: a motion to the right becomes a motion upwards.
  const MotionField field = [&] {
    EgoMotion motion = steady_motion(Vector3d::Zero(), {0, 0, kPi / 2}, 1);
    return MotionField(vga(), motion, {});
  }();
  Circle circle;
  circle.rebel = true;
  circle.location = vga().centre_px;
  circle.origin = vga().centre_px - Vec2(50, 0);
  circle.speed = 40;
  AllLayers layers;
  layers.rebel_circles = {circle};
  predict_all(layers, field);
  EXPECT_TRUE(layers.rebel_circles[0].location.isApprox(vga().centre_px + Vec2(0, -40), 1e-9));
}

TEST(Kinematics, WhileStillTheOriginIsThePrincipalPoint) {
  const MotionField still(vga(), steady_motion(Vector3d::Zero(), {0, 0.1, 0}, 0.1), {});
  EXPECT_FALSE(still.foe());
  EXPECT_EQ(still.origin({100, 50}), vga().centre_px);
}

/// A drift below the still speed counts as none: static layers keep place, size and depth.
TEST(Kinematics, WhileStillStaticLayersStay) {
  const MotionField still(vga(), steady_motion({0, 0, 0.004}, Vector3d::Zero(), 0.1), {});
  Circle circle;
  circle.location = {450, 300};
  circle.radius = 20;
  Square square;
  square.location = {450, 300};
  square.half_size = {20, 10};
  AllLayers layers;
  layers.normal_circles = {circle};
  layers.squares = {square};
  predict_all(layers, still);
  EXPECT_TRUE(layers.normal_circles[0].location.isApprox(circle.location, 1e-12));
  EXPECT_TRUE(layers.squares[0].location.isApprox(square.location, 1e-12));
  EXPECT_EQ(layers.squares[0].half_size, square.half_size);
  EXPECT_EQ(layers.squares[0].depth_ratio, 1);
  EXPECT_EQ(layers.normal_circles[0].depth_ratio, 1);
}

/// An item that turns behind the camera has no image; it stays finite and in place.
TEST(Kinematics, PointTurnedBehindTheCameraStaysWhereItWas) {
  const MotionField field(vga(), steady_motion(Vector3d::Zero(), {0, 3.1, 0}, 1), {});
  for (const Vec2& x : {Vec2(10, 20), Vec2(320, 240), Vec2(630, 470)}) {
    EXPECT_EQ(field.rotated(x), x);
  }
}

/// A camera that drives and turns, and static patches of known depth.
struct Driving : ::testing::Test {
  Random random{3};
  FieldParameters parameters;

  struct Case {
    EgoMotion motion;
    Vec2 before, now;
    double ratio_before, growth;
  };
  Case any() {
    Case c;
    c.motion = steady_motion(
        {random.uniform(-0.3, 0.3), random.uniform(-0.3, 0.3), random.uniform(-0.8, 0.8)},
        random.vector(0.3), 0.1);
    const double depth = random.uniform(2, 8);
    c.before = middle_pixel(random);
    const Vector3d turned = c.motion.R_cur_prev * back_project(vga(), c.before, depth);
    const Vector3d x_C = turned - c.motion.v_C_mps * c.motion.dt_s;
    c.now = project(vga(), x_C);
    c.ratio_before = parameters.reference_depth_m / turned.z();  // of the rotated camera
    c.growth = turned.z() / x_C.z();
    return c;
  }
};

TEST_F(Driving, ANormalCircleGoesAndGrowsAsItsStaticPatchDoesAndSoDoPsiAndLambda) {
  for (int i = 0; i < 200; ++i) {
    const Case c = any();
    Circle circle;
    circle.location = c.before;
    circle.radius = 20;
    circle.depth_ratio = c.ratio_before;
    circle.trust = PaperParameters{}.circle.trust.standard;
    AllLayers layers;
    layers.normal_circles = {circle, circle};
    layers.normal_circles[1].ignoring = true;
    const MotionField field(vga(), c.motion, parameters);
    CircleSteps().predict(layers, field);
    EXPECT_TRUE(layers.normal_circles[0].location.isApprox(c.now, 1e-9));
    EXPECT_NEAR(layers.normal_circles[0].radius, 20 * c.growth, 1e-9);
    Feedback feedback({});
    PaperLayers paper;
    feedback.set_regions(layers.normal_circles, {}, paper);
    const auto& [psi, lambda, alpha] = paper;
    ASSERT_EQ(psi.size(), 1u);
    ASSERT_EQ(lambda.size(), 1u);
    EXPECT_TRUE(psi[0].location.isApprox(c.now, 1e-9));
    EXPECT_NEAR(psi[0].size.x(), 20 * c.growth, 1e-9);
    EXPECT_TRUE(lambda[0].location.isApprox(c.now, 1e-9));
    EXPECT_NEAR(lambda[0].radius, 20 * c.growth, 1e-9);
  }
}

TEST_F(Driving, ANormalSquareGoesAndGrowsAboutTheFocusOfNow) {
  for (int i = 0; i < 200; ++i) {
    const Case c = any();
    const MotionField field(vga(), c.motion, parameters);
    Square square;
    square.location = c.before;
    square.half_size = {30, 15};
    square.depth_ratio = c.ratio_before;
    square.origin = vga().centre_px;  // where the FOE was in the previous frame
    AllLayers layers;
    layers.squares = {square};
    SquareSteps().predict(layers, field);
    EXPECT_LT((layers.squares[0].location - c.now).norm(), 1e-6) << c.before.transpose();
    // The stand-in for an FOE at infinity, 100 focal lengths away, adds this small growth.
    EXPECT_TRUE(
        layers.squares[0].half_size.isApprox(Vec2(30, 15) * c.growth, field.foe() ? 1e-6 : 2e-3));
    EXPECT_EQ(layers.squares[0].origin, field.origin(field.rotated(c.before)));
    EXPECT_NEAR(angle_between(layers.squares[0].angle, angle_of(field.direction(c.now))), 0, 1e-9);
  }
}

/// beta of a normal edge is the direction from the FOE, also in frames in which it finds no corner.
TEST_F(Driving, BetaOfANormalEdgeIsItsDirectionOfFlowAlsoWhileItCoasts) {
  for (int i = 0; i < 200; ++i) {
    const Case c = any();
    const MotionField field(vga(), c.motion, parameters);
    AllLayers layers;
    layers.normal_edges = {from_origin<Edge>(random)};
    layers.normal_edges[0].trust = 4;
    EdgeSteps experts;
    experts.predict(layers, field);
    experts.update(layers, Chi{}, {}, field);
    ASSERT_EQ(layers.normal_edges.size(), 1u);
    const Edge& edge = layers.normal_edges[0];
    EXPECT_EQ(edge.location, edge.predicted);
    EXPECT_NEAR(angle_between(edge.angle, angle_of(field.direction(edge.location))), 0, 1e-9);
  }
}

TEST_F(Driving, TheOriginOfNormalLandmarksIsTheFocus) {
  for (int i = 0; i < 50; ++i) {
    const Case c = any();
    const MotionField field(vga(), c.motion, parameters);
    if (!field.foe()) continue;
    AllLayers layers;
    layers.normal_edges = {from_origin<Edge>(random)};
    layers.normal_circles = {from_origin<Circle>(random)};
    layers.squares = {from_origin<Square>(random)};
    predict_all(layers, field);
    EXPECT_EQ(layers.normal_edges[0].origin, *field.foe());
    EXPECT_EQ(layers.normal_circles[0].origin, *field.foe());
    EXPECT_EQ(layers.squares[0].origin, *field.foe());
  }
}

/// "Velocities of the Circle and Square experts are always updated with new vehicle velocity": the
/// state keeps V / V_v.
TEST_F(Driving, WhenTheVehicleChangesItsSpeedStaticLayersDo) {
  Circle circle;
  circle.location = {450, 300};
  circle.radius = 20;
  circle.depth_ratio = 0.01;  // far away, so that the interval does not change it
  Square square;
  square.location = circle.location;
  square.half_size = {20, 20};
  square.depth_ratio = circle.depth_ratio;
  const auto speeds = [&](double v) {
    AllLayers layers;
    layers.normal_circles = {circle};
    layers.squares = {square};
    const MotionField field(vga(), steady_motion({0, 0, v}, Vector3d::Zero(), 0.01), parameters);
    predict_all(layers, field);
    return std::pair(layers.normal_circles[0].speed, layers.squares[0].speed);
  };
  const auto slow = speeds(0.2), fast = speeds(0.6);
  ASSERT_GT(slow.first, 0);
  EXPECT_NEAR(fast.first / slow.first, 3, 1e-4);
  EXPECT_NEAR(fast.second / slow.second, 3, 1e-4);
}

}  // namespace
}  // namespace lcs
