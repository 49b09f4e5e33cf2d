// The `recording` of a scenario, instead of a scene.
#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "scenarios/scenes.h"
#include "tests/scenarios/scenario_file.h"
#include "tests/tools/refusal.h"

namespace lcs::scenario {
namespace {

/// A folder with a scenario and a file of each kind.
class RecordingKeys : public testing::Test {
 protected:
  RecordingKeys() {
    std::filesystem::create_directory(folder_.path() / "drive");
    for (const char* name : {"poses.txt", "imu.csv", "wheels.csv", "mask.png", "gt.txt"}) {
      folder_.write(name, "");
    }
  }
  Scenario loaded(const std::string& keys, const LoadOptions& options = {}) const {
    return load(folder_.write("test.yaml", keys), options);
  }
  std::string refused(const std::string& keys) const {
    return without_folder(test::refusal_of<input::Error>([&] { loaded(keys); }), folder_);
  }
  const ScenarioFolder folder_;
};

TEST_F(RecordingKeys, APathIsEnoughAndAllElseIsUnknown) {
  const Scenario s = loaded("recording: {path: drive}\n", {.sets = {}, .seed = 7});
  ASSERT_TRUE(s.recording);
  EXPECT_EQ(s.recording->path, folder_.path() / "drive");
  EXPECT_EQ(s.recording->source.line, 1);
  EXPECT_EQ(s.recording->format, "");
  EXPECT_EQ(s.recording->every, 1);
  EXPECT_FALSE(s.recording->fps || s.recording->poses || s.recording->imu || s.recording->odometry);
  EXPECT_FALSE(s.recording->speed_mps || s.recording->focal_px || s.recording->centre_px);
  EXPECT_FALSE(s.recording->distortion || s.recording->camera_height_m || s.recording->mask);
  EXPECT_FALSE(s.recording->mount_rpy_rad || s.recording->at_rest_s || s.recording->labels);
  EXPECT_FALSE(s.recording->nothing_moves || s.recording->split);
  EXPECT_EQ(s.frames, 0) << "all there are";
  EXPECT_EQ(s.seed, 1u) << "a recording is the same whatever the seed";
  EXPECT_EQ(s.groups, std::vector<std::string>{"short"});
  EXPECT_TRUE(s.scene.empty());
  EXPECT_EQ(s.world.at("recording.path"), "drive");
  EXPECT_TRUE(shadowed_files(s).empty());
}

TEST_F(RecordingKeys, AreReadWithTheirUnits) {
  const Scenario s = loaded(
      "recording:\n"
      "  {path: drive, format: pictures, camera: cam1, fps: 25 Hz, every: 2, imu: imu.csv,\n"
      "   odometry: wheels.csv, speed: 36 km/h, focal: 700 px, centre: [320, 240 px],\n"
      "   distortion: [-0.3, 0.1, 0, 0, 0.02], camera_height: 165 cm, mount: [0, 3 deg, 180],\n"
      "   mask: mask.png, at_rest: 2 s, labels: gt.txt, split: test}\n"
      "frames: 40\nego_motion: truth\ncorners: {threshold: 30}\nfilter: {circle.mu_0: 20}\n"
      "criteria: [{metric: rebel.f1, min: 0.5}]\ngroups: [real]\n");
  const RecordingSource& r = s.recording.value();
  EXPECT_EQ(r.format, "pictures");
  EXPECT_EQ(r.camera, "cam1");
  EXPECT_EQ(r.fps, 25);
  EXPECT_EQ(r.every, 2);
  EXPECT_EQ(r.imu, folder_.path() / "imu.csv");
  EXPECT_EQ(r.odometry, folder_.path() / "wheels.csv");
  EXPECT_EQ(r.speed_mps, 10);
  EXPECT_EQ(r.focal_px, Eigen::Vector2d(700, 700));
  EXPECT_EQ(r.centre_px, Eigen::Vector2d(320, 240));
  ASSERT_TRUE(r.distortion);
  EXPECT_FALSE(r.distortion->equidistant);
  EXPECT_EQ(r.distortion->coefficients, (std::vector<double>{-0.3, 0.1, 0, 0, 0.02}));
  EXPECT_DOUBLE_EQ(r.camera_height_m.value(), 1.65);
  EXPECT_DOUBLE_EQ(r.mount_rpy_rad.value().y(), std::numbers::pi / 60);
  EXPECT_EQ(r.mask, folder_.path() / "mask.png");
  EXPECT_EQ(r.at_rest_s, 2);
  EXPECT_EQ(r.labels, folder_.path() / "gt.txt");
  EXPECT_EQ(r.split, RecordingSource::Split::test);
  EXPECT_EQ(s.frames, 40);
  EXPECT_EQ(s.ego_motion, EgoMotionSource::truth);
  EXPECT_EQ(s.fast_threshold, 30);
  EXPECT_EQ(s.filter.size(), 1u);
  EXPECT_EQ(s.criteria.size(), 1u);
  EXPECT_EQ(s.groups, (std::vector<std::string>{"real", "test"})) << "a suite chooses by a split";
}

TEST_F(RecordingKeys, OfAFisheyeAndOfPoses) {
  const Scenario s = loaded(
      "recording:\n  path: drive\n  poses: poses.txt\n  nothing_moves: true\n"
      "  distortion: {equidistant: [0.1, 0, 0, 0]}\n");
  EXPECT_EQ(s.recording->poses, folder_.path() / "poses.txt");
  EXPECT_TRUE(s.recording->nothing_moves);
  EXPECT_TRUE(s.recording->distortion.value().equidistant);
  EXPECT_EQ(s.recording->distortion->coefficients.size(), 4u);
}

TEST_F(RecordingKeys, CanBeSweptAndSet) {
  const Scenario s =
      loaded("recording: {path: drive}\nsweep: {recording.camera_height: [1 m, 2 m]}\n",
             {.sets = {"recording.camera_height=1.5 m"}, .seed = {}});
  EXPECT_EQ(s.recording->camera_height_m, 1.5);
  EXPECT_EQ(s.sweep.size(), 1u);
}

TEST_F(RecordingKeys, WrongKeysAreRefusedAtTheirLine) {
  const std::string more = "recording:\n  path: drive\n  ";
  const std::pair<std::string, std::string> cases[] = {
      {"recording: {path: drive}\nscene: lab\n",
       "test.yaml:1: both scene and recording are given; keep one of them"},
      {"recording: {path: drive}\nego: {}\n",
       "test.yaml:2: both recording and ego are given; keep one of them"},
      {"recording: {path: drive}\norigin: {family: room, seed: 3}\n",
       "test.yaml:2: both recording and origin are given; keep one of them"},
      {"recording: {path: drive}\nseed: 3\n",
       "test.yaml:2: both recording and seed are given; keep one of them"},
      {"recording: {}\n",
       "test.yaml:1: recording needs 'path'; add it (scenarios/README.md shows how)"},
      {"recording: {path: nowhere}\n",
       "test.yaml:1: recording.path: there is no folder or video nowhere; give its path relative "
       "to "
       "the scenario file"},
      {more + "poses: none.txt\n",
       "test.yaml:3: recording.poses: there is no file none.txt; give its path relative to the "
       "scenario file"},
      {more + "camera_hieght: 1 m\n",
       "test.yaml:3: unknown key 'camera_hieght' in recording; did you mean 'camera_height'?"},
      {more + "camera_height: 1 s\n",
       "test.yaml:3: recording.camera_height: '1 s' is a time; give a length in m, cm, mm or km"},
      {more + "camera_height: 0\n",
       "test.yaml:3: recording.camera_height is '0'; it must be above 0 and at most 10000 m"},
      {more + "fps: 0\n",
       "test.yaml:3: recording.fps is '0'; it must be above 0 and at most 10000 Hz"},
      {more + "every: 0\n",
       "test.yaml:3: recording.every is '0'; give a whole number from 1 to 10000"},
      {more + "format: rosbag\n",
       "test.yaml:3: recording.format is 'rosbag'; give euroc, kitti, kitti_odometry, "
       "kitti_tracking, kitti_360, robotcar, tum_rgbd, rpg_events, listed, mot, bag, video or "
       "pictures"},
      {more + "distortion: [0.1, 0, 0, 0]\n",
       "test.yaml:3: recording.distortion is a list of 4; give a list of 5, as in [0, 0, 0, 0, 0]"},
      {more + "distortion: {fisheye: [0, 0, 0, 0]}\n",
       "test.yaml:3: unknown key 'fisheye' in recording.distortion; known are equidistant"},
      {more + "distortion: {}\n",
       "test.yaml:3: recording.distortion needs 'equidistant'; add it (scenarios/README.md shows "
       "how)"},
      {more + "poses: poses.txt\n  imu: imu.csv\n",
       "test.yaml:4: both recording.poses and recording.imu are given; keep one of them"},
      {more + "labels: gt.txt\n  nothing_moves: true\n",
       "test.yaml:4: both recording.labels and recording.nothing_moves are given; keep one of "
       "them"},
      {more + "odometry: wheels.csv\n",
       "test.yaml:1: recording needs 'imu'; add it (scenarios/README.md shows how)"},
      {more + "split: all\n",
       "test.yaml:3: recording.split is 'all'; give train, validate or test"},
      {more + "mask:\n", "test.yaml:3: recording.mask has no value; give one or remove the key"},
      {more + "mask: [a]\n", "test.yaml:3: recording.mask is a list; give a text"},
  };
  for (const auto& [text, message] : cases) EXPECT_EQ(refused(text), message);
}

}  // namespace
}  // namespace lcs::scenario
