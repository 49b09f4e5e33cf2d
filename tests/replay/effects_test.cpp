// Each option of a recording, on each layout, changes something or is refused or is told to have no
// effect.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <opencv2/imgproc.hpp>
#include <string>

#include "scenarios/load.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/temporary_folder.h"
#include "tests/tools/videos.h"
#include "tools/app/replay.h"
#include "tools/replay/playback.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;
using test::write;

constexpr int kFrames = 4;

/// An example of each key's value.
const std::map<std::string, std::string> kValues{
    {"camera", "cam7"},
    {"topics.image", "{image: /a}"},
    {"topics.camera_info", "{camera_info: /a}"},
    {"topics.imu", "{imu: /a}"},
    {"topics.poses", "{poses: /a}"},
    {"topics.odometry", "{odometry: /a}"},
    {"topics.world", "{world: map}"},
    {"fps", "12"},
    {"times", "own/times.csv"},
    {"time_unit", "ms"},
    {"every", "2"},
    {"poses", "own/poses.txt"},
    {"imu", "own/imu.csv"},
    {"odometry", "own/odometry.csv"},
    {"speed", "3"},
    {"time_offset", "20 ms"},
    {"at_rest", "0.6 s"},
    {"calibration", "own/camera.yaml"},
    {"imu_calibration", "own/imu.yaml"},
    {"focal", "123"},
    {"centre", "[70, 50]"},
    {"distortion", "[0.1, 0, 0, 0, 0]"},
    {"equidistant", "{equidistant: [0.1, 0, 0, 0]}"},
    {"camera_height", "1.5 m"},
    {"mount", "[0, 10, 0]"},
    {"bayer", "rggb"},
    {"bits", "12"},
    {"mask", "own/mask.png"},
    {"labels", "own/gt.txt"},
    {"labels_video", "first"},
    {"nothing_moves", "true"},
    {"split", "test"},
};

class Effects : public testing::Test {
 protected:
  Effects() {
    std::string times = "time_s\n", imu = "time_s,w_x,w_y,w_z,a_x,a_y,a_z\n", poses, odometry;
    for (int k = 0; k < kFrames; ++k) {
      times += fmt::format("{:.2f}\n", 100 + 0.12 * k);
      poses += fmt::format("{:.2f} 0 0 {} 0 0 0 1\n", 99.9 + 0.2 * k, 0.1 * k * k);
    }
    for (int i = 0; i < 400; ++i) {
      imu += fmt::format("{:.3f},0.01,0,0.1,{},0.1,9.8\n", 99 + 0.005 * i, 1e-3 * i);
    }
    odometry = "#timestamp [s],v_RB_B_x,v_RB_B_y,v_RB_B_z\n";
    for (int i = 0; i < 400; ++i) odometry += fmt::format("{:.3f},1,0,0\n", 99 + 0.005 * i);
    write(home() / "own/times.csv", times);
    write(home() / "own/poses.txt", poses);
    write(home() / "own/imu.csv", imu);
    write(home() / "own/odometry.csv", odometry);
    write(home() / "own/camera.yaml",
          "camera_model: pinhole\nintrinsics: [150, 150, 80, 60]\ndistortion_model: none\n"
          "T_BS: [[0, 0, 1, 0], [-1, 0, 0, 0], [0, -1, 0, 0], [0, 0, 0, 1]]\n");
    write(home() / "own/imu.yaml",
          "gyroscope_noise_density: 0.1\ngyroscope_random_walk: 0.1\n"
          "accelerometer_noise_density: 0.1\naccelerometer_random_walk: 0.1\n");
    write(home() / "own/gt.txt", "2,1,10,10,20,20,1,1,1\n");
    cv::Mat1b mask(120, 160, uchar{0});
    mask.colRange(0, 80) = 255;
    test::write_picture(home() / "own/mask.png", mask);
  }
  fs::path home() const { return home_.path(); }
  void draw(const fs::path& folder, const std::string& format) const {
    for (int k = 0; k < kFrames; ++k) {
      cv::Mat3b picture(120, 160);
      cv::randu(picture, 0, 250);
      test::write_picture(folder / fmt::format(fmt::runtime(format), k), picture);
    }
  }

  /// All of a replay that a run depends on, and what is told to have no effect.
  std::string seen(const std::string& recording) const {
    write(home() / "drive.yaml", "recording: {" + recording + "}\n");
    Playback playback(scenario::load(home() / "drive.yaml"));
    const scenario::Scenario& scenario = playback.scenario();
    std::string all = fmt::format("{} {} {} {}", scenario.groups.size(),
                                  scenario.imu.noise.gyroscope_noise_density,
                                  playback.camera().focal_px, playback.camera().centre_px.x());
    recording::FrameRecord frame;
    for (cv::Mat3b image; playback.next(frame, image);) {
      frame.corners_px = {{20, 20}, {140, 100}};
      const cv::Scalar sums = cv::sum(image);
      playback.straighten(frame.corners_px, image);
      playback.label(frame);
      all += fmt::format("\n{} {} {} {} {}", frame.t_ns, sums[0], sums[1],
                         frame.labels.has_value() && !frame.labels->empty(),
                         static_cast<int>(playback.info().truth));
      for (const Eigen::Vector2f& px : frame.corners_px)
        all += fmt::format(" {} {}", px.x(), px.y());
      for (const double x : frame.motion.R_cur_prev.reshaped()) all += fmt::format(" {}", x);
      for (const double x : frame.motion.v_C_mps) all += fmt::format(" {}", x);
      for (const double x : frame.motion.ground.value_or(Ground{}).up_C)
        all += fmt::format(" {}", x);
      all += fmt::format(" {}", frame.motion.ground.has_value());
    }
    for (const std::string& line : playback.remarks()) {
      const bool is_told = line.find("no effect") != line.npos ||
                           line.find("where up is is not known") != line.npos ||
                           line.find("noise of the IMU") != line.npos;
      if (is_told) all += '\n' + line;
    }
    return all;
  }

  /// \param base keys of a recording of a layout that can be read.
  /// \param states_units its tables state their unit of time, which counts.
  void expect_effects(const std::string& base, bool states_units = false) const {
    const std::string before = seen(base);
    for (const app::RecordingKey& key : app::recording_keys()) {
      const auto value = kValues.find(key.key);
      ASSERT_NE(value, kValues.end()) << key.key << " has no example here";
      std::string name = value->first.substr(0, value->first.find('.'));
      if (name == "equidistant") name = "distortion";
      if (base.find(' ' + name + ':') != base.npos) continue;  // the layout needs it
      if (states_units && name == "time_unit") continue;
      std::string after;
      try {
        after = seen(base + ", " + name + ": " + value->second);
      } catch (const std::runtime_error& refused) {
        after = refused.what();
      }
      EXPECT_NE(after, before) << base << ": " << value->first;
    }
  }
  const test::TemporaryFolder home_;
};

TEST_F(Effects, OnPictures) {
  draw(home() / "pictures", "{}.png");
  expect_effects("path: pictures, fps: 10, focal: 100, speed: 1");
  expect_effects("path: pictures, focal: 100, times: own/times.csv, imu: own/imu.csv", true);
  expect_effects("path: pictures, focal: 100, times: own/times.csv, poses: own/poses.txt", true);
  expect_effects(
      "path: pictures, times: own/times.csv, imu: own/imu.csv, calibration: own/camera.yaml", true);
}

TEST_F(Effects, OnNamesThatAreTimes) {
  draw(home() / "pictures", "100.{}0.png");
  expect_effects("path: pictures, focal: 100, speed: 1");
}

TEST_F(Effects, OnLists) {
  draw(home() / "drive/rgb", "{}.png");
  std::string list;
  for (int k = 0; k < kFrames; ++k) list += fmt::format("{:.2f} rgb/{}.png\n", 100 + 0.1 * k, k);
  write(home() / "drive/rgb.txt", list);
  write(home() / "drive/groundtruth.txt", "99.9 0 0 0 0 0 0 1\n100.6 0 0 1 0 0 0 1\n");
  expect_effects("path: drive, focal: 100", true);
  fs::rename(home() / "drive/rgb.txt", home() / "drive/images.txt");
  expect_effects("path: drive, format: listed, focal: 100, speed: 1");
  draw(home() / "mot/img1", "{:06}.png");
  write(home() / "mot/seqinfo.ini", "[Sequence]\nimDir=img1\nframeRate=10\nseqLength=4\n");
  expect_effects("path: mot, focal: 100, speed: 1");
}

TEST_F(Effects, OnKittiOdometry) {
  draw(home() / "00/image_0", "{:06}.png");
  std::string times, poses;
  for (int k = 0; k < kFrames; ++k) {
    times += fmt::format("{:.1f}\n", 0.1 * k);
    poses += fmt::format("1 0 0 0 0 1 0 0 0 0 1 {}\n", 0.1 * k);
  }
  write(home() / "00/times.txt", times);
  write(home() / "00/poses.txt", poses);
  write(home() / "00/calib.txt",
        "P0: 100 0 80 0 0 100 60 0 0 0 1 0\nP1: 100 0 80 0 0 100 60 0 0 0 1 0\n");
  expect_effects("path: 00");
}

TEST_F(Effects, OnEuroc) {
  constexpr std::int64_t kStart_ns = 100'000'000'000;
  std::string list = "#timestamp [ns],filename\n";
  for (int k = 0; k < kFrames; ++k) {
    list += fmt::format("{0},{0}.png\n", kStart_ns + 100'000'000LL * k);
    test::write_picture(
        home() / fmt::format("run/mav0/cam0/data/{}.png", kStart_ns + 100'000'000LL * k),
        cv::Mat3b(120, 160, cv::Vec3b(9, 9, static_cast<uchar>(k))));
  }
  write(home() / "run/mav0/cam0/data.csv", list);
  write(home() / "run/mav0/cam0/sensor.yaml",
        "rate_hz: 10\n" + test::read(home() / "own/camera.yaml"));
  write(home() / "own/camera.yaml",
        "camera_model: pinhole\nintrinsics: [170, 170, 80, 60]\ndistortion_model: none\n");
  write(home() / "run/mav0/imu0/data.csv", test::read(home() / "own/imu.csv"));
  expect_effects("path: run", true);
}

TEST_F(Effects, OnVideos) {
  auto video = test::new_video(home() / "drive.avi", "MJPG", 10, {160, 120});
  for (int k = 0; k < kFrames; ++k) video->write(cv::Mat3b(120, 160, cv::Vec3b(99, 9, 9)));
  video.reset();
  expect_effects("path: drive.avi, focal: 100, speed: 1");
}

}  // namespace
}  // namespace lcs::replay
