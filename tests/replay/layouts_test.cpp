// Layouts of data sets, written here for a vehicle whose motion is known in closed form.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "sim/camera/rectifier.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

using sim::Rectifier;

namespace fs = std::filesystem;
using test::write;

scenario::RecordingSource asked(const fs::path& path) {
  scenario::RecordingSource recording;
  recording.path = path;
  return recording;
}

/// Drives a circle to the left at a constant speed, in a world with x east, y north, z up.
struct Circle {
  static constexpr double kSpeed_mps = 5, kYawRate_radps = 0.2, kStart_rad = 0.7;
  static double yaw(double t) { return kStart_rad + kYawRate_radps * t; }
  static double east(double t) { return kSpeed_mps * std::cos(yaw(t)); }
  static double north(double t) { return kSpeed_mps * std::sin(yaw(t)); }
};

/// The camera looks ahead, upright, at the vehicle's origin: it moves along its z, and turns about
/// its -y. The mean of a velocity that turns by an angle a is shorter by a^2 / 24.
void expect_circle(Recorded& recorded, double dt_s) {
  const double turn = Circle::kYawRate_radps * dt_s;
  EXPECT_EQ(recorded.motion->at(recorded.frames[0].t_ns).dt_s, 0);
  for (std::size_t i = 1; i < recorded.frames.size(); ++i) {
    const EgoMotion motion = recorded.motion->at(recorded.frames[i].t_ns);
    EXPECT_NEAR(motion.dt_s, dt_s, 1e-6);
    EXPECT_NEAR(motion.w_C_radps.y(), -Circle::kYawRate_radps, 1e-5);
    EXPECT_NEAR(motion.w_C_radps.x(), 0, 1e-5);
    EXPECT_NEAR(motion.w_C_radps.z(), 0, 1e-5);
    EXPECT_NEAR(motion.v_C_mps.z(), Circle::kSpeed_mps, Circle::kSpeed_mps * turn * turn / 2);
    // In the final camera frame, the mean velocity is turned by half the angle.
    EXPECT_NEAR(motion.v_C_mps.x(), Circle::kSpeed_mps * turn / 2, 1e-3);
    EXPECT_NEAR(motion.v_C_mps.y(), 0, 1e-9);
  }
}

std::string kitti_time(double t) {
  return fmt::format("2011-09-26 13:02:{:012.9f}", 25 + t);
}

class Layouts : public testing::Test {
 protected:
  /// A KITTI raw drive at 10 Hz whose states are at the frames' times.
  fs::path kitti(int frames) {
    const fs::path drive = home_.path() / "2011_09_26" / "drive_0001_sync";
    std::string times;
    for (int k = 0; k < frames; ++k) {
      const double t = 0.1 * k;
      times += kitti_time(t) + "\n";
      write(drive / "oxts/data" / fmt::format("{:010}.txt", k),
            fmt::format("49.0 8.4 116 0 0 {} {} {} 5 0 0{}\n", Circle::yaw(t), Circle::north(t),
                        Circle::east(t), " 0 0 9.8 0 0 9.8 0 0 0.2 0 0 0.2 0.1 0.05 4 10 4 4 0"));
    }
    write(drive / "oxts/timestamps.txt", times);
    write(drive / "image_02/timestamps.txt", times);
    fs::create_directories(drive / "image_02/data");
    return drive;
  }
  const test::TemporaryFolder home_;
};

TEST_F(Layouts, KittiRawGivesTheMotionOfItsNavigationUnit) {
  const fs::path drive = kitti(6);
  EXPECT_EQ(layout_of(asked(drive)).name, "kitti");
  Recorded recorded = read_kitti(asked(drive), false);
  ASSERT_EQ(recorded.frames.size(), 6u);
  EXPECT_EQ(recorded.frames[3].picture, drive / "image_02/data/0000000003.png");
  EXPECT_EQ(recorded.frames[1].t_ns - recorded.frames[0].t_ns, 100'000'000);
  EXPECT_FALSE(recorded.lens) << "there is no calibration";
  expect_circle(recorded, 0.1);
}

TEST_F(Layouts, KittiRawTakesItsCalibrationFromTheFolderOfTheDate) {
  const fs::path drive = kitti(3);
  const fs::path date = drive.parent_path();
  // Axes as in KITTI: scanner ahead, left, up; camera right, down, ahead. The second camera is
  // 0.06 m to the left of the first, P[3] = f * 0.06.
  write(date / "calib_cam_to_cam.txt",
        "calib_time: 09-Jan-2012 13:57:47\nS_rect_02: 1242 375\n"
        "R_rect_00: 1 0 0 0 1 0 0 0 1\n"
        "P_rect_02: 700 0 600 42 0 700 180 0 0 0 1 0\n");
  write(date / "calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n");
  write(date / "calib_velo_to_cam.txt", "R: 0 -1 0 0 0 -1 1 0 0\nT: 0 -0.08 -0.27\n");
  Recorded recorded = read_kitti(asked(drive), false);
  ASSERT_TRUE(recorded.lens);
  EXPECT_EQ(recorded.lens->fu_px, 700);
  EXPECT_EQ(recorded.lens->cv_px, 180);
  // The camera has a lever arm to the unit: in a turn to the left a point ahead of it moves left,
  // too, and a point left of the centre line is slower.
  recorded.motion->at(recorded.frames[0].t_ns);
  const EgoMotion motion = recorded.motion->at(recorded.frames[1].t_ns);
  const double ahead = 0.8 + 0.27, left = -0.3 + 0.06;
  EXPECT_NEAR(motion.v_C_mps.z(), Circle::kSpeed_mps - Circle::kYawRate_radps * left, 2e-3);
  EXPECT_NEAR(motion.v_C_mps.x(), Circle::kSpeed_mps * 0.01 - Circle::kYawRate_radps * ahead, 2e-3);
}

TEST_F(Layouts, KittiRawRefusesACalibrationThatTurnsNothing) {
  const fs::path drive = kitti(3);
  const fs::path date = drive.parent_path();
  write(date / "calib_cam_to_cam.txt",
        "R_rect_00: 1 0 0 0 1 0 0 0 1\nP_rect_02: 700 0 600 42 0 700 180 0 0 0 1 0\n");
  write(date / "calib_imu_to_velo.txt", "R: 1 0 0 0 1 0 0 0 1\nT: -0.8 0.3 -0.8\n");
  for (const char* R : {"0 -1 0 0 0 61 1 0 0", "1 0 0 0 1 0 0 0 -1", "0 0 0 0 0 0 0 0 0"}) {
    write(date / "calib_velo_to_cam.txt", fmt::format("R: {}\nT: 0 -0.08 -0.27\n", R));
    const std::string told =
        test::refusal_of<input::Error>([&] { read_kitti(asked(drive), false); });
    EXPECT_NE(told.find("calib_velo_to_cam.txt"), told.npos) << R << ": " << told;
    EXPECT_NE(told.find("R is no rotation"), told.npos) << R << ": " << told;
  }
}

TEST_F(Layouts, KittiTrackingHasItsStatesInOneFileAndTenPicturesASecond) {
  const fs::path root = home_.path() / "training", pictures = root / "image_02/0004";
  std::string states;
  for (int k = 0; k < 6; ++k) {
    const double t = 0.1 * k;
    states += fmt::format("49.0 8.4 116 0 0 {} {} {} 5 0 0{}\n", Circle::yaw(t), Circle::north(t),
                          Circle::east(t), " 0 0 9.8 0 0 9.8 0 0 0.2 0 0 0.2 0.1 0.05 4 10 4 4 0");
    test::write_picture(pictures / fmt::format("{:06}.png", k), cv::Mat1b(375, 1242, uchar{0}));
  }
  write(root / "oxts/0004.txt", states);
  std::string calibration;
  for (int k = 0; k < 4; ++k) {
    calibration += fmt::format("P{}: 700 0 600 0 0 700 180 0 0 0 1 0\n", k);
  }
  write(root / "calib/0004.txt", calibration +
                                     "R_rect 1 0 0 0 1 0 0 0 1\n"
                                     "Tr_velo_cam 0 -1 0 0 0 0 -1 0 1 0 0 0\n"
                                     "Tr_imu_velo 1 0 0 0 0 1 0 0 0 0 1 0\n");
  for (const fs::path& path : {pictures, root}) {
    EXPECT_EQ(layout_of(asked(path)).name, "kitti_tracking") << path;
    Recorded recorded = read_kitti_tracking(asked(path), false);
    ASSERT_EQ(recorded.frames.size(), 6u);
    EXPECT_EQ(recorded.lens->cu_px, 600);
    expect_circle(recorded, 0.1);
  }
  test::write_picture(root / "image_02/0005/000000.png", cv::Mat1b(375, 1242, uchar{0}));
  write(root / "calib/0005.txt", calibration);
  EXPECT_NE(test::refusal_of<std::runtime_error>([&] {
              layout_of(asked(root));
            }).find("holds several sequences"),
            std::string::npos);
}

TEST_F(Layouts, Kitti360HasPosesOfSomePictures) {
  const fs::path root = home_.path(), drive = root / "data_2d_raw/2013_05_28_drive_0000_sync";
  std::string times, poses;
  for (int k = 0; k < 9; ++k) {
    times += fmt::format("2013-05-28 08:46:02.{}00000000\n", k);
    // At 5 m/s, and not of each picture; x right, y down, z ahead.
    if (k % 4 == 0) poses += fmt::format("{} 1 0 0 0 0 1 0 0 0 0 1 {} 0 0 0 1\n", k, 0.5 * k);
  }
  write(drive / "image_00/timestamps.txt", times);
  test::write_picture(drive / "image_00/data_rect/0000000000.png", cv::Mat1b(9, 9, uchar{0}));
  write(root / "calibration/perspective.txt",
        "P_rect_00: 552 0 682 0 0 552 238 0 0 0 1 0\nS_rect_00: 1408 376\n");
  write(root / "data_poses" / drive.filename() / "cam0_to_world.txt", poses);
  EXPECT_EQ(layout_of(asked(drive)).name, "kitti_360");
  Recorded recorded = read_kitti_360(asked(drive), false);
  ASSERT_EQ(recorded.frames.size(), 9u);
  EXPECT_EQ(recorded.lens->width_px, 1408);
  recorded.motion->at(recorded.frames[0].t_ns);
  for (std::size_t k = 1; k < 9; ++k) {
    EXPECT_NEAR(recorded.motion->at(recorded.frames[k].t_ns).v_C_mps.z(), 5, 1e-9);
  }
}

TEST_F(Layouts, OfListedPicturesHaveTheTimesOfTheirList) {
  for (int k = 0; k < 3; ++k) {
    test::write_picture(home_.path() / fmt::format("img/image_0_{}.png", k),
                        cv::Mat1b(9, 9, uchar{0}));
  }
  write(home_.path() / "images.txt",
        "# id timestamp image_name\n0 1545305824.900 img/image_0_0.png\n"
        "1 1545305824.933 img/image_0_1.png\n2 1545305824.967 img/image_0_2.png\n");
  EXPECT_EQ(layout_of(asked(home_.path())).name, "listed");
  const Recorded recorded = read_listed(asked(home_.path()), false);
  ASSERT_EQ(recorded.frames.size(), 3u);
  EXPECT_EQ(recorded.frames[2].t_ns, 1'545'305'824'967'000'000);
}

TEST_F(Layouts, EurocOfTumViHasMotionCaptureAndNamesThatAreTimes) {
  constexpr std::int64_t kStart_ns = 1'520'530'308'000'000'000;
  const fs::path mav = home_.path() / "mav0";
  std::string imu =
      "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y,w_RS_S_z,a_RS_S_x,a_RS_S_y,a_RS_S_z\n";
  std::string mocap =
      "#timestamp [ns], p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], "
      "q_RS_z []\n";
  for (int k = 0; k < 200; ++k) {
    imu += fmt::format("{},0,0,0,0,0,9.81\n", kStart_ns + 5'000'000 * k);
    mocap += fmt::format("{},{},0,0,1,0,0,0\n", kStart_ns + 5'000'000 * k, 0.01 * k);  // 2 m/s
    if (k % 10 == 0) {
      test::write_picture(mav / fmt::format("cam0/data/{}.png", kStart_ns + 5'000'000 * k),
                          cv::Mat1b(9, 9, uchar{0}));
    }
  }
  write(mav / "imu0/data.csv", imu);
  write(mav / "mocap0/data.csv", mocap);
  EXPECT_EQ(layout_of(asked(home_.path())).name, "euroc");
  scenario::RecordingSource ahead = asked(home_.path());
  EXPECT_FALSE(read_euroc(ahead, false).lacks.empty()) << "where the camera is on the IMU";
  ahead.mount_rpy_rad = Eigen::Vector3d::Zero();
  Recorded recorded = read_euroc(ahead, false);
  ASSERT_EQ(recorded.frames.size(), 20u);
  for (const RecordedFrame& frame : recorded.frames) {
    const EgoMotion motion = recorded.motion->at(frame.t_ns);
    if (motion.dt_s > 0) {
      EXPECT_NEAR(motion.v_C_mps.z(), 2, 1e-6);
    }
  }
}

TEST_F(Layouts, RobotCarGivesTheMotionOfItsInertialUnitFromNorthEastDown) {
  const fs::path run = home_.path() / "2014-05-19";
  std::string list,
      ins =
          "timestamp,ins_status,latitude,longitude,altitude,northing,easting,down,utm_zone,"
          "velocity_north,velocity_east,velocity_down,roll,pitch,yaw\n";
  const std::int64_t start_us = 1'400'505'794'141'322;
  for (int k = 0; k <= 50; ++k) {  // 50 Hz
    const double t = 0.02 * k;
    // Clockwise from north.
    const double heading = std::numbers::pi / 2 - Circle::yaw(t);
    ins += fmt::format("{},INS_SOLUTION_GOOD,51.7,-1.2,110,0,0,0,30U,{},{},0,0,0,{}\n",
                       start_us + 20'000 * k, Circle::north(t), Circle::east(t), heading);
  }
  for (int k = 0; k < 6; ++k) list += fmt::format("{} 1\n", start_us + 62'500 * k);
  write(run / "gps/ins.csv", ins);
  write(run / "stereo.timestamps", list);
  fs::create_directories(run / "stereo/centre");
  EXPECT_EQ(layout_of(asked(run)).name, "robotcar");
  Recorded recorded = read_robotcar(asked(run), false);
  ASSERT_EQ(recorded.frames.size(), 6u);
  EXPECT_EQ(recorded.frames[0].picture, run / "stereo/centre/1400505794141322.png");
  expect_circle(recorded, 0.0625);

  write(run / "mono_rear.timestamps", list);
  fs::create_directories(run / "mono_rear");
  scenario::RecordingSource behind = asked(run);
  behind.camera = "mono_rear";
  EXPECT_EQ(read_robotcar(behind, false).lacks.size(), 1u) << "where it looks is not known";
  behind.mount_rpy_rad = Eigen::Vector3d(0, 0, std::numbers::pi);
  Recorded rear = read_robotcar(behind, false);
  EXPECT_TRUE(rear.lacks.empty());
  rear.motion->at(rear.frames[0].t_ns);
  EXPECT_NEAR(rear.motion->at(rear.frames[1].t_ns).v_C_mps.z(), -Circle::kSpeed_mps, 1e-3);
}

TEST_F(Layouts, RawPicturesOfRobotCarHaveTheirColours) {
  const std::pair<const char*, std::array<int, 4>> patterns[] = {
      {"stereo/centre", {1, 0, 2, 1}},  // G B / R G, as indices of BGR
      {"mono_rear", {2, 1, 1, 0}},      // R G / G B
  };
  for (const auto& [camera, pattern] : patterns) {
    const cv::Vec3b colour(40, 120, 200);
    cv::Mat1b raw(32, 48);
    for (int y = 0; y < raw.rows; ++y) {
      for (int x = 0; x < raw.cols; ++x) {
        raw(y, x) = colour[pattern[static_cast<std::size_t>(2 * (y % 2) + x % 2)]];
      }
    }
    const fs::path run = home_.path() / "run";
    const std::string name = std::string(camera).substr(0, std::string(camera).find('/'));
    fs::create_directories(run / camera);
    test::write_picture(run / camera / "10.png", raw);
    write(run / (name + ".timestamps"), "10 1\n20 1\n");
    write(run / "gps/ins.csv",
          "timestamp,velocity_north,velocity_east,velocity_down,roll,pitch,yaw\n"
          "10,0,0,0,0,0,0\n20,0,0,0,0,0,0\n");
    scenario::RecordingSource raw_pictures = asked(run);
    raw_pictures.camera = camera;
    raw_pictures.mount_rpy_rad = Eigen::Vector3d::Zero();
    const Recorded recorded = read_robotcar(raw_pictures, false);
    PictureReader reader(recorded.format);
    const auto picture = reader.read(recorded.frames[0]);
    ASSERT_TRUE(picture);
    EXPECT_EQ((*picture)(16, 24), colour) << camera;
    EXPECT_EQ((*picture)(17, 25), colour) << camera;
  }
}

TEST_F(Layouts, AFolderOfNothingKnownIsToldSo) {
  fs::create_directories(home_.path() / "empty");
  EXPECT_THROW(layout_of(asked(home_.path() / "empty")), input::Error);
}

TEST_F(Layouts, RefuseWithTheFolderThatAnyRecordingCanBeTurnedInto) {
  for (const RecordingLayout& layout : layouts()) {
    scenario::Scenario scenario;
    scenario::RecordingSource& asked = scenario.recording.emplace();
    asked.source = {"drive.yaml", 1};
    asked.path = home_.path() / "nothing";
    asked.format = layout.name;
    fs::create_directories(asked.path);
    std::string refused;
    try {
      read_recorded(scenario);
    } catch (const std::runtime_error& error) {
      refused = error.what();
    }
    EXPECT_NE(refused.find("NEUTRAL.md"), refused.npos) << layout.name << ": " << refused;
  }
}

TEST_F(Layouts, HaveTheNamesThatScenariosTake) {
  ASSERT_EQ(layouts().size(), scenario::kRecordingFormats.size());
  for (std::size_t i = 0; i < layouts().size(); ++i) {
    EXPECT_EQ(layouts()[i].name, scenario::kRecordingFormats[i]);
  }
}

TEST(Rectifier, TakesCornersToWhereAPinholeSeesThem) {
  const cv::Size size(320, 240);
  // f r (1 + k1 r^2) with k1 = -0.1 at 45 degrees, f atan(r) at 45 degrees.
  const Lens barrel{200, 200, 99.5, 119.5, Lens::Distortion::radial_tangential, {-0.1, 0, 0, 0, 0}};
  const Lens fisheye{200, 200, 99.5, 119.5, Lens::Distortion::equidistant, {0, 0, 0, 0}};
  for (const auto& [lens, x] :
       {std::pair(barrel, 99.5 + 180), std::pair(fisheye, 99.5 + 200 * std::numbers::pi / 4)}) {
    std::vector<Eigen::Vector2f> corners{{static_cast<float>(x), 119.5F}, {99.5F, 119.5F}};
    Rectifier(lens, size).rectify(corners);
    ASSERT_EQ(corners.size(), 2u);
    EXPECT_NEAR(corners[0].x(), 299.5, 0.01);
    EXPECT_NEAR(corners[0].y(), 119.5, 0.01);
    EXPECT_NEAR(corners[1].x(), 99.5, 0.01);
  }
  // Points outside of the pinhole's picture of that size are dropped.
  std::vector<Eigen::Vector2f> outside{{319, 119.5}};
  Rectifier(barrel, size).rectify(outside);
  EXPECT_TRUE(outside.empty());
  // Beyond the radius at which the polynomial turns back, a pixel has no unique ray.
  const Lens folded{
      200, 200, 159.5, 119.5, Lens::Distortion::radial_tangential, {-0.6, 0, 0, 0, 0}};
  std::vector<Eigen::Vector2f> no_ray{{319, 119.5}, {170, 120}};
  Rectifier(folded, size).rectify(no_ray);
  EXPECT_EQ(no_ray.size(), 1u);
  // A box becomes the bounding box of its mapped outline.
  double left = 89, top = 109, right = 280, bottom = 131;
  Rectifier(barrel, size).rectify(left, top, right, bottom);
  EXPECT_NEAR(right, 300, 1);
  EXPECT_NEAR(left, 89, 0.1);
}

TEST(Rectifier, LeavesAPinholeAloneAndStraightensABarrel) {
  const cv::Size size(320, 240);
  cv::Mat3b picture(size);
  cv::randu(picture, 0, 256);
  const Lens pinhole{200, 200, 159.5, 119.5, Lens::Distortion::radial_tangential, {0, 0, 0, 0}};
  cv::Mat3b same = picture.clone();
  Rectifier(pinhole, size).rectify(same);
  EXPECT_EQ(cv::norm(same, picture, cv::NORM_INF), 0);

  // A dot at the image of a point at 45 degrees to the right through a lens with k1 = -0.1: at
  // f r (1 + k1 r^2) = 180 px from the centre instead of 200.
  const Lens barrel{200, 200, 99.5, 119.5, Lens::Distortion::radial_tangential, {-0.1, 0, 0, 0}};
  cv::Mat3b dot(size, cv::Vec3b(0, 0, 0));
  cv::circle(dot, {280, 120}, 3, {255, 255, 255}, cv::FILLED);
  Rectifier(barrel, size).rectify(dot);
  cv::Mat1b grey;
  cv::cvtColor(dot, grey, cv::COLOR_BGR2GRAY);
  const cv::Moments moments = cv::moments(grey);
  EXPECT_NEAR(moments.m10 / moments.m00, 99.5 + 200, 1.5);
  EXPECT_NEAR(moments.m01 / moments.m00, 120, 1);
}

}  // namespace
}  // namespace lcs::replay
