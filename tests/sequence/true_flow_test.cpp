#include "tools/sequence/true_flow.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <optional>

#include "scenarios/load.h"
#include "sim/simulation.h"

namespace lcs::sequence {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();

/// A camera that looks at a wall with a panel before it.
struct PanelBeforeWall {
  static constexpr float kWall_m = 4, kPanel_m = 2;
  static constexpr int kLeft = 40, kRight = 60;

  sim::Pinhole camera{100, {49.5, 39.5}, 100, 80};
  sim::FrameTruth truth;
  cv::Mat1f next_depth;
  cv::Mat1i next_object;

  /// \param ego_m,panel_m displacement of each to the right until the next frame, m.
  PanelBeforeWall(double ego_m, double panel_m) {
    truth.now.T_WO.resize(2);
    truth.next.T_WO.resize(2);
    truth.next.T_WC.p.x() = ego_m;
    truth.next.T_WO[1].p.x() = panel_m;
    draw(0, truth.depth_m, truth.object);
    const double moved_px = camera.focal_px * (panel_m - ego_m) / kPanel_m;
    draw(static_cast<int>(std::lround(moved_px)), next_depth, next_object);
  }
  TrueFlow field() const {
    return true_flow(camera, truth, truth.object, {next_depth, next_object});
  }

 private:
  static void draw(int shift, cv::Mat1f& depth, cv::Mat1i& object) {
    depth = cv::Mat1f(80, 100, kWall_m);
    object = cv::Mat1i(80, 100, 0);
    const cv::Rect panel(kLeft + shift, 20, kRight - kLeft, 40);
    depth(panel) = kPanel_m;
    object(panel) = 1;
  }
};

TEST(TrueFlow, OfAPanelBeforeAWallIsWhatThePinholeSays) {
  const PanelBeforeWall scene(0.1, 0.3);
  const TrueFlow field = scene.field();
  // f t / z: the panel moves by 0.3 - 0.1 m at 2 m, the rest by -0.1 m.
  EXPECT_NEAR(field.full_px(40, 50)[0], 100 * 0.2 / 2, 1e-5);
  EXPECT_NEAR(field.ego_px(40, 50)[0], -100 * 0.1 / 2, 1e-5);
  EXPECT_NEAR(field.full_px(40, 20)[0], -100 * 0.1 / 4, 1e-5);
  EXPECT_NEAR(field.ego_px(40, 20)[0], -100 * 0.1 / 4, 1e-5);
  EXPECT_NEAR(field.full_px(40, 50)[1], 0, 1e-5);
}

TEST(TrueFlow, MarksWhatIsHiddenInTheNextFrameAndWhatLeavesThePicture) {
  const PanelBeforeWall scene(0, 0.2);  // the panel moves by 10 px, the wall stays
  const TrueFlow field = scene.field();
  EXPECT_EQ(field.seen(40, 50), 1) << "the panel itself";
  EXPECT_EQ(field.seen(40, 20), 1) << "wall far from it";
  EXPECT_EQ(field.seen(40, 65), 0) << "wall that the panel moves in front of";
  EXPECT_EQ(field.seen(40, 75), 1) << "wall beyond it";
  EXPECT_EQ(field.ego_seen(40, 50), 1);

  const TrueFlow leaving = PanelBeforeWall(1, 1).field();  // all moves left: the wall by 25 px
  EXPECT_EQ(leaving.seen(40, 10), 0);
  EXPECT_NEAR(leaving.full_px(40, 10)[0], -25, 1e-4) << "its motion is known all the same";
}

TEST(TrueFlow, OfAThinBodyWithoutAPixelInTheNextFrameIsNotSeenThere) {
  PanelBeforeWall scene(0, 0);
  cv::Mat1i surfaces = scene.truth.object.clone();
  surfaces(40, 20) = 7;  // a wire on the wall, of the same body and depth
  const TrueFlow field =
      true_flow(scene.camera, scene.truth, surfaces, {scene.next_depth, scene.next_object});
  EXPECT_EQ(field.seen(40, 20), 0);
  EXPECT_EQ(field.seen(40, 21), 1);
  EXPECT_FALSE(std::isnan(field.full_px(40, 20)[0])) << "its motion is known all the same";
}

TEST(TrueFlow, IsUndefinedOnTheSkyAndOnTheRover) {
  PanelBeforeWall scene(0.5, 0);
  for (cv::Mat1f* depth : {&scene.truth.depth_m, &scene.next_depth}) {
    depth->rowRange(0, 10) = kInfinity;
  }
  for (cv::Mat1i* object : {&scene.truth.object, &scene.next_object}) {
    object->rowRange(0, 10) = -1;
    object->rowRange(70, 80) = -1;  // the rover, at its own depth
  }
  const TrueFlow field = scene.field();
  for (const int row : {5, 75}) {
    EXPECT_TRUE(std::isnan(field.full_px(row, 50)[0]));
    EXPECT_TRUE(std::isnan(field.ego_px(row, 50)[0]));
    EXPECT_EQ(field.seen(row, 50), 0);
    EXPECT_EQ(field.ego_seen(row, 50), 0);
  }
}

TEST(TrueFlow, OfPointsBehindTheNextCameraIsUndefined) {
  PanelBeforeWall scene(0, 0);
  scene.truth.next.T_WC.p.z() = 3;  // past the panel
  const TrueFlow field = scene.field();
  EXPECT_TRUE(std::isnan(field.full_px(40, 50)[0]));
  EXPECT_EQ(field.seen(40, 50), 0);
  EXPECT_FALSE(std::isnan(field.full_px(40, 20)[0]));
}

TEST(TrueFlow, OfRenderedFramesIsTheTruthOfCornersThere) {
  // The truth of corners uses other code and algebra, and is tested against exact rays.
  const scenario::Scenario scenario = scenario::load(LCS_SCENARIOS_DIR "/crossing.yaml");
  sim::Simulation simulation(scenario);
  for (int k = 0; k < 20; ++k) simulation.skip();  // until both movers are in view
  const std::optional<sim::Observation> now = simulation.next(), next = simulation.next();
  const sim::Pinhole& camera = simulation.calibration().camera;
  const TrueFlow field =
      true_flow(camera, now->truth, now->geom, {next->truth.depth_m, next->geom});
  std::vector<Eigen::Vector2f> places;
  for (int y = 1; y < camera.height_px - 1; y += 3) {
    for (int x = 1; x < camera.width_px - 1; x += 3) {
      // Corners take the nearest of 3x3 pixels: use only places where that is the pixel itself.
      double nearest = 0;
      cv::minMaxLoc(now->truth.depth_m(cv::Rect(x - 1, y - 1, 3, 3)), &nearest);
      if (nearest == now->truth.depth_m(y, x)) places.emplace_back(x, y);
    }
  }
  const auto truth = sim::label_corners(camera, now->truth, places, 0.5);
  int rebels = 0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (truth[i].label == sim::Label::none) continue;
    const cv::Point at(static_cast<int>(places[i].x()), static_cast<int>(places[i].y()));
    // A float of some hundred pixels has a resolution of 1e-5 px.
    EXPECT_NEAR(field.full_px(at)[0], truth[i].motion_px.x(), 1e-4);
    EXPECT_NEAR(field.full_px(at)[1], truth[i].motion_px.y(), 1e-4);
    EXPECT_NEAR(field.ego_px(at)[0], truth[i].static_motion_px.x(), 1e-4);
    EXPECT_NEAR(field.ego_px(at)[1], truth[i].static_motion_px.y(), 1e-4);
    rebels += truth[i].label == sim::Label::rebel;
  }
  EXPECT_GT(rebels, 100) << "moving objects are part of what was compared";
}

}  // namespace
}  // namespace lcs::sequence
