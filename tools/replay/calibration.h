/// \file
/// Calibrations of a camera and an IMU, as several tools write them: EuRoC's sensor.yaml, Kalibr's
/// and OpenVINS's camchain and IMU, ROS's camera_info, OpenCV, ORB-SLAM, VINS (camodocal).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "scenarios/scenario.h"
#include "sim/base/pose.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

struct SensorCalibration {
  std::optional<Lens> lens;  ///< of a camera
  /// Pose of the sensor in the body frame B: EuRoC's T_BS; of a camera also Kalibr's T_cam_imu,
  /// inverted, OpenVINS's T_imu_cam, ORB-SLAM's T_b_c1, and VINS's body_T_cam0. Then B is the IMU.
  std::optional<sim::Pose> T_BS;
  std::optional<double> rate_hz;
  std::optional<double> time_offset_s;      ///< of a camera: Kalibr's timeshift_cam_imu, VINS's td
  bool has_cameras = false;                 ///< the name of a camera chose one of several
  std::optional<scenario::ImuNoise> noise;  ///< of an IMU; turn-on biases are 0
  std::map<std::string, input::Source> keys = {};  ///< top-level keys and their places
};

/// \param camera one of several in a file, by its name there, as "cam1"; another name: the first.
/// \throws input::Error with file and line, also if it is of none of the known kinds.
SensorCalibration read_calibration(const std::filesystem::path& file,
                                   const std::string& camera = "");

}  // namespace lcs::replay
