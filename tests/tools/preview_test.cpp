// `lcs preview`: the faults that it finds, the content of its page, and the world that it writes.
#include "tools/preview/preview.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>

#include "scenarios/load.h"
#include "sim/pictures/picture_file.h"
#include "sim/scene/model.h"
#include "tests/sim/model_of.h"
#include "tests/tools/command.h"
#include "tests/tools/files.h"
#include "tests/tools/temporary_folder.h"

namespace lcs::preview {
namespace {

namespace fs = std::filesystem;
using test::CommandResult;
using test::read;

/// A crate beside the rover's way, and a box that passes.
constexpr const char* kScene =
    "<mujoco><worldbody><light pos='0 0 5'/><geom name='floor' type='plane' size='20 20 .1'/>"
    "<geom name='pillar' type='box' pos='8 0 1' size='.3 .3 1' rgba='.2 .2 .2 1'/>"
    "<body name='crate' pos='4 2 .3'><geom type='box' size='.3 .3 .3' rgba='.9 .9 .9 1'/></body>"
    "</worldbody></mujoco>";
constexpr const char* kScenario = R"(purpose: a box goes by
scene: scene.xml
frames: 20
camera: {size: [160, 120]}
ego: {start: [0 m, 0 m], speed: 0.5 m/s}
actors:
  walker:
    shape: box
    trajectory: {line: {from: [3 m, -1 m], heading: 90 deg, speed: 1 m/s}}
)";

class PreviewCommand : public testing::Test {
 protected:
  PreviewCommand() {
    std::ofstream(folder_.path() / "scene.xml") << kScene;
    std::ofstream(folder_.path() / "mine.yaml") << kScenario;
  }
  scenario::Scenario load(const std::vector<std::string>& sets = {}) const {
    return scenario::load(folder_.path() / "mine.yaml", {.sets = sets, .seed = {}});
  }
  /// All faults in one text.
  std::string wrong(const std::vector<std::string>& sets) const {
    std::string all;
    for (const std::string& line : preview(load(sets)).wrong) all += line + "\n";
    return all;
  }
  const test::TemporaryFolder folder_;
};

TEST_F(PreviewCommand, TellsWhoGoesWhereAndWhoIsSeen) {
  const Preview p = preview(load());
  EXPECT_EQ(p.wrong, std::vector<std::string>{});
  ASSERT_EQ(p.movers.size(), 1u);
  const PreviewMover& walker = p.movers.front();
  ASSERT_TRUE(walker.moves);
  EXPECT_NEAR(walker.moves->to_s, 1.9, 1e-9);  // the last of 20 frames at 10 Hz
  EXPECT_NEAR((walker.way_m.back() - Eigen::Vector2d(3, 0.9)).norm(), 0, 1e-6);
  EXPECT_NEAR((p.survey.rover_m.back() - Eigen::Vector2d(0.95, 0)).norm(), 0, 1e-3);
  // at 1.6 s they are at (0.8, 0) and (3, 0.6); the last frames give the nearest distance
  EXPECT_LT(walker.nearest_m, 2.3);
  EXPECT_EQ(walker.looks, kLooks);
  EXPECT_EQ(p.corners_px.size(), static_cast<std::size_t>(kLooks));
}

TEST_F(PreviewCommand, ALargeCameraIsLookedThroughAtASmallerSize) {
  const std::vector<std::string> large{"camera.size=[4096, 2048]", "frames=2", "image.noise=none"};
  const Preview p = preview(load(large));
  ASSERT_EQ(p.looks.size(), 2u);
  for (const Look& look : p.looks) {
    EXPECT_EQ(look.image_px, cv::Size(2896, 1448)) << "four million pixels of the same view";
    const std::string_view bytes(reinterpret_cast<const char*>(look.jpeg.data()), look.jpeg.size());
    EXPECT_EQ(sim::picture_size(bytes).value_or(cv::Size2l()), cv::Size2l(look.image_px));
  }
  EXPECT_EQ(p.movers.front().looks, 2);
  write_preview(folder_.path() / "page.html", load(large), p);
  EXPECT_NE(read(folder_.path() / "page.html").find("made at 2896 x 1448 pixels"),
            std::string::npos);
  EXPECT_EQ(preview(load({"frames=1"})).looks.front().image_px, cv::Size(160, 120));
}

TEST_F(PreviewCommand, TellsWhatIsWrongWithItsLine) {
  const std::string inside = wrong({"actors.walker.trajectory.line.from=[4 m, 2 m]"});
  EXPECT_NE(inside.find("mine.yaml:7: actor 'walker' starts inside object 'crate'"),
            std::string::npos)
      << inside;
  EXPECT_EQ(inside.find("passes through"), std::string::npos) << "told once: " << inside;
  const std::string twice =
      wrong({"actors.walker.trajectory.line="
             "{from: [2.6 m, 2.7 m], heading: -26.6 deg, speed: 4 m/s}"});
  EXPECT_NE(twice.find("'walker' passes through object 'crate'"), std::string::npos) << twice;
  EXPECT_NE(twice.find("'walker' passes through the setting's geom 'pillar'"), std::string::npos)
      << twice;
  const std::string behind = wrong({"actors.walker.trajectory.line.from=[-3 m, 0 m]"});
  EXPECT_NE(behind.find("'walker' is in none of the 13 pictures"), std::string::npos) << behind;
  const std::string waits = wrong({"actors.walker.start.time=1 min"});
  EXPECT_NE(waits.find("'walker' never moves"), std::string::npos) << waits;
  const std::string hidden = wrong({"ego.start=[6.8 m, 0 m]", "camera.position=[1 m, 0 m, 0.5 m]"});
  EXPECT_NE(hidden.find("the camera is inside the setting's geom 'pillar' at 0.00 s"),
            std::string::npos)
      << hidden;
  const std::string blind = wrong({"corners.threshold=254"});
  EXPECT_NE(blind.find("fewer than 10 corners are in 13 of 13 pictures"), std::string::npos)
      << blind;
}

TEST_F(PreviewCommand, ThePageIsWrittenAlsoWhereARunIsRefused) {
  const std::vector<std::string> set{"--set", "actors.walker.trajectory.line.from=[4 m, 2 m]"};
  const auto run = [&](std::vector<std::string> arguments) {
    arguments.insert(arguments.end(), set.begin(), set.end());
    return test::run_lcs(arguments, {.folder = folder_.path()});
  };
  EXPECT_EQ(run({"run", "mine.yaml"}).exit_code, 2);
  const CommandResult result = run({"preview", "mine.yaml"});
  EXPECT_EQ(result.exit_code, 1) << result.err;
  EXPECT_NE(result.err.find("'walker' starts inside object 'crate'"), std::string::npos)
      << result.err;
  const std::string page = read(folder_.path() / "out" / "preview" / "mine.html");
  EXPECT_NE(page.find("starts inside object 'crate'"), std::string::npos);
  EXPECT_NE(page.find("frame 0,"), std::string::npos);
  EXPECT_NE(page.find("frame 19,"), std::string::npos);
  EXPECT_EQ(page.find("http"), std::string::npos) << "asks the network for nothing";
}

TEST_F(PreviewCommand, TheWorldThatItWritesLoadsAgainAndStandsAsAtTheStart) {
  const CommandResult result = test::run_lcs(
      {"preview", "mine.yaml", "--quiet", "--mjcf", "world.xml", "--set", "ego.start=[1 m, 0 m]"},
      {.folder = folder_.path()});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.out, "");
  sim::Model model = sim::test::model_of(read(folder_.path() / "world.xml"));
  mj_forward(&model.m(), &model.d());
  const Eigen::Vector3d walker = model.body_pose(model.id(mjOBJ_BODY, "walker")).p;
  EXPECT_NEAR((walker.head<2>() - Eigen::Vector2d(3, -1)).norm(), 0, 1e-6);
  const Eigen::Vector3d camera = model.camera_pose(model.id(mjOBJ_CAMERA, "ego/camera")).p;
  EXPECT_NEAR((camera - Eigen::Vector3d(1.2, 0, 0.45)).norm(), 0, 1e-6);
  EXPECT_TRUE(model.has(mjOBJ_BODY, "crate"));
  EXPECT_FALSE(model.m().opt.disableflags & mjDSBL_CONTACT) << "what is added to it can stand";

  test::write(folder_.path() / "world.mjb", sim::world_file(load(), sim::WorldFormat::mjb));
  const std::unique_ptr<mjModel, sim::ModelDeleter> binary(
      mj_loadModel((folder_.path() / "world.mjb").c_str(), nullptr));
  ASSERT_TRUE(binary);
  EXPECT_EQ(binary->nbody, model.m().nbody);
}

TEST_F(PreviewCommand, RecordedFramesHaveNoWorldToShow) {
  fs::create_directory(folder_.path() / "pictures");
  std::ofstream(folder_.path() / "drive.yaml") << "recording: {path: pictures, focal: 100 px}\n";
  const CommandResult result = test::run_lcs({"preview", "drive.yaml"}, {.folder = folder_.path()});
  EXPECT_EQ(result.exit_code, 2);
  EXPECT_NE(result.err.find("there is no world to simulate"), std::string::npos) << result.err;
  EXPECT_FALSE(fs::exists(folder_.path() / "out"));
}

}  // namespace
}  // namespace lcs::preview
