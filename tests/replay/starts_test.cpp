// The start of dead reckoning: up, biases and speed by the first readings of an IMU.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <filesystem>
#include <vector>

#include "scenarios/load.h"
#include "tests/tools/files.h"
#include "tests/tools/pictures.h"
#include "tests/tools/refusal.h"
#include "tests/tools/temporary_folder.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

constexpr int kPeriod_ms = 5;

/// Readings of an IMU with x right, y down, z ahead, which turns about z and begins upright.
std::vector<sim::ImuSample> readings(double turn_radps, int bumps, double sign = 1) {
  std::vector<sim::ImuSample> all;
  for (int i = 0; i <= 200; ++i) {
    const double angle = turn_radps * 1e-3 * kPeriod_ms * i;
    sim::ImuSample& reading = all.emplace_back();
    reading.t_ns = std::int64_t{1'000'000} * kPeriod_ms * i;
    reading.gyro_radps = {0, 0, turn_radps};
    reading.accel_mps2 =
        sign * 9.81 * (Eigen::AngleAxisd(-angle, Vector3d::UnitZ()) * -Vector3d::UnitY());
    if (i < bumps) reading.accel_mps2.z() -= 4;
  }
  return all;
}

TEST(Beginning, IsAMeanThatABumpDoesNotTilt) {
  for (const int bumps : {0, 1, 20}) {
    const Beginning beginning = beginning_of(readings(0, bumps));
    EXPECT_LT((beginning.up_S_mps2.normalized() + Vector3d::UnitY()).norm(), 1e-9) << bumps;
    EXPECT_TRUE(beginning.is_still());
  }
}

TEST(Beginning, IsTurnedBackByTheGyroscope) {
  const Beginning beginning = beginning_of(readings(2, 1));
  EXPECT_LT((beginning.up_S_mps2.normalized() + Vector3d::UnitY()).norm(), 1e-6);
  EXPECT_FALSE(beginning.is_still()) << "a rate of 2 rad/s is no bias";
}

TEST(Beginning, OfOneReadingIsThatReading) {
  EXPECT_LT(
      (beginning_of(std::vector(1, readings(0, 0)[0])).up_S_mps2.normalized() + Vector3d::UnitY())
          .norm(),
      1e-9);
}

/// Pictures with an IMU whose axes are the camera's.
class StartOfPictures : public testing::Test {
 protected:
  Recorded read(const std::vector<sim::ImuSample>& samples, const std::string& more) {
    const std::filesystem::path home = home_.path();
    for (int k = 0; k < 4; ++k) {
      test::write_picture(home / fmt::format("pictures/{}.png", k), cv::Mat1b(120, 160, uchar{9}));
    }
    std::string imu = "time_ns,w_x,w_y,w_z,a_x,a_y,a_z\n";
    for (const sim::ImuSample& one : samples) {
      imu += fmt::format("{},{},{},{},{},{},{}\n", one.t_ns, one.gyro_radps.x(), one.gyro_radps.y(),
                         one.gyro_radps.z(), one.accel_mps2.x(), one.accel_mps2.y(),
                         one.accel_mps2.z());
    }
    test::write(home / "imu.csv", imu);
    test::write(home / "camera.yaml",
                "cam0:\n  camera_model: pinhole\n  intrinsics: [100, 100, 79.5, 59.5]\n"
                "  distortion_model: none\n  resolution: [160, 120]\n"
                "  T_cam_imu: [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]\n");
    test::write(home / "drive.yaml",
                "recording: {path: pictures, fps: 10, imu: imu.csv, calibration: camera.yaml, "
                "speed: 2" +
                    more + "}\n");
    return read_recorded(scenario::load(home / "drive.yaml"));
  }
  const test::TemporaryFolder home_;
};

TEST_F(StartOfPictures, IsUprightAfterABumpAtTheFirstReading) {
  const Recorded recorded = read(readings(0, 1), ", camera_height: 1.5 m");
  EXPECT_LT((recorded.motion->up_C().value() + Vector3d::UnitY()).norm(), 1e-9);
  for (const RecordedFrame& frame : recorded.frames) {
    const EgoMotion motion = recorded.motion->at(frame.t_ns);
    if (motion.dt_s > 0) {
      EXPECT_NEAR(motion.v_C_mps.z(), 2, 0.05);
    }
  }
}

TEST_F(StartOfPictures, IsUprightAfterReadingsOfNoSensor) {
  for (const double size : {1e3, 1e200, 1e306}) {
    std::vector<sim::ImuSample> samples = readings(0, 0);
    samples[0].accel_mps2.x() = samples[2].gyro_radps.y() = samples[4].gyro_radps.y() = size * 100;
    const Recorded recorded = read(samples, ", camera_height: 1.5 m");
    EXPECT_LT((recorded.motion->up_C().value() + Vector3d::UnitY()).norm(), 1e-9) << size;
    const std::vector<std::string> told = recorded.tally.lines();
    EXPECT_TRUE(std::ranges::any_of(told, [](const std::string& line) {
      return line.starts_with("3 readings are beyond those of any IMU");
    })) << size;
  }
}

TEST_F(StartOfPictures, WithAGroundAboveThePictureIsRefused) {
  const auto upside_down = [&](const char* more) {
    return test::refusal_of<input::Error>([&] { read(readings(0, 0, -1), more); });
  };
  EXPECT_NE(upside_down(", camera_height: 1.5 m").find("iOS"), std::string::npos);
  EXPECT_EQ(upside_down(""), "nothing was refused") << "the ground is not needed";
}

}  // namespace
}  // namespace lcs::replay
