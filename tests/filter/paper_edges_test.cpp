
#include <gtest/gtest.h>

#include "filter/kinematics/geometry.h"
#include "filter/paper/paper_filter.h"
#include "tests/filter/paper_steps.h"

namespace lcs {
namespace {

using namespace paper;
using testing::AllLayers;
using testing::CircleSteps;
using testing::EdgeSteps;
using testing::SquareSteps;

using Eigen::Vector3d;
using testing::Random;
using testing::sparse_world;
using testing::steady_motion;
using testing::vga;
using testing::World;

/// An edge 150 px right of the FOE at the reference depth, predicted by a camera that moves ahead.
struct Classified : ::testing::Test {
  Classified() : field(vga(), motion, PaperParameters{}.field) {
    AllLayers layers;
    Edge start;
    start.location = vga().centre_px + Vec2(150, 0);
    start.mu = 25;
    start.trust = 4;
    layers.normal_edges = {start};
    experts.predict(layers, field);
    edge = layers.normal_edges.front();
  }

  Xi at(double ahead, double aside) const {
    return experts.expert.classify(edge, edge.predicted + Vec2(ahead, aside), field);
  }

  EgoMotion motion = steady_motion({0, 0, 1}, Vector3d::Zero(), 0.2);
  EdgeSteps experts;
  MotionField field;
  Edge edge;
};

TEST_F(Classified, PredictionIsTheReferenceSpeedAlongTheRay) {
  // V_v = v_z r / Z_ref = 150 / 3 = 50 px/s, for 0.2 s.
  EXPECT_NEAR((edge.predicted - edge.rotated).norm(), 10, 1e-9);
}

TEST_F(Classified, AtThePredictionOrBeyondIsTwo) {
  EXPECT_EQ(at(0, 0), Xi::two);
  EXPECT_EQ(at(10, 0), Xi::two);
  EXPECT_EQ(at(0, 15), Xi::two);
}

TEST_F(Classified, ShortOfThePredictionIsThree) {
  EXPECT_EQ(at(-6, 0), Xi::three);
}

TEST_F(Classified, BeyondTheRadiusAtASpeedOfANearPointIsOne) {
  // 26 px beyond the prediction: 36 px in all, the flow of a point at 150 * 0.2 / 36 = 0.83 m.
  EXPECT_EQ(at(26, 0), Xi::one);
}

TEST_F(Classified, AgainstTheFieldIsFourInsideTheRadiusToo) {
  EXPECT_EQ(at(-10 - 3, 0), Xi::four);
  EXPECT_EQ(at(-10 - 30, 0), Xi::four);
}

TEST_F(Classified, FasterThanTheNearestPointIsFour) {
  EXPECT_EQ(at(40, 0), Xi::four);  // 50 px a frame: 0.6 m, below the plausible 0.8 m
}

TEST_F(Classified, OutsideTheSpanIsFive) {
  const double half_width = 160 * std::sin(9 * kPi / 180) + 1.5;
  EXPECT_EQ(at(0, half_width + 1), Xi::five);
  EXPECT_NE(at(0, half_width - 1), Xi::five);
  EXPECT_EQ(at(-400, 0), Xi::five);  // beyond the FOE, on the other side
}

/// The paper's rule on a sparse world with one point that moves towards the FOE.
TEST(Alpha, APointAgainstTheFieldIsARebelOnItsThirdSightingNotBeforeAndNotAfter) {
  for (const double speed : {5.0, 12.0, 30.0}) {  // px a frame
    SCOPED_TRACE(speed);
    World world = sparse_world(3, 80);
    const EgoMotion motion = steady_motion({0, 0, 0.2}, Vector3d::Zero(), 0.1);
    PaperParameters parameters;
    parameters.ignore = false;
    PaperFilter filter(world.camera, parameters);
    // A gap between the grid's rows and columns; it enters the image's middle after three frames.
    Vec2 mover(560, 240);
    for (int k = 0; k < 8; ++k) {
      std::vector<Eigen::Vector2f> corners = world.corners();
      const bool seen = k >= 3;
      if (seen) corners.push_back(mover.cast<float>());
      const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
      if (seen) {
        const bool third = k >= 5;
        EXPECT_EQ(result.verdicts.back() == Verdict::rebel, third) << "sighting " << k - 2;
        mover.x() -= speed;
      }
      world.advance(motion);
    }
  }
}

TEST(Alpha, ARadialIncomerNearerThanAnyStaticPointIsFoundByItsSpeedAlone) {
  World world = sparse_world(4, 80);
  const EgoMotion motion = steady_motion({0, 0, 0.5}, Vector3d::Zero(), 0.1);
  PaperParameters parameters;
  parameters.ignore = false;
  PaperFilter filter(world.camera, parameters);
  // Towards the camera's image plane at 4 m/s: away from the FOE, like a static point, but as fast
  // as a point at 0.55 m; the nearest plausible depth is 0.8 m.
  world.add({420, 240}, 5, {0, 0, -4});
  bool found = false;
  for (int k = 0; k < 5; ++k) {
    const std::vector<Eigen::Vector2f> corners = world.corners();
    const FrameResult& result = filter.step(corners, k == 0 ? EgoMotion{} : motion);
    found = found || result.verdicts.back() == Verdict::rebel;
    world.advance(motion);
  }
  EXPECT_TRUE(found);
}

TEST(Alpha, ChainsLiveThreeFramesAtTheMost) {
  PaperFilter filter(vga());
  const EgoMotion motion = steady_motion({0, 0, 0.2}, Vector3d::Zero(), 0.1);
  Random random(5);
  std::vector<Eigen::Vector2f> corners;
  for (int i = 0; i < 40; ++i) corners.emplace_back(random.uniform(0, 639), random.uniform(0, 479));
  filter.step(corners, {});
  for (int k = 0; k < 2; ++k) filter.step({}, motion);
  EXPECT_TRUE(filter.step({}, motion).paper.chains.empty());
}

}  // namespace
}  // namespace lcs
