/// \file
/// Tables that tell a motion: poses of TUM's RGB-D benchmark, KITTI's odometry, KITTI-360 and
/// EuRoC's truth; sensors' tables in EuRoC's ASL format. Unreadable rows are left out, rows out of
/// order sorted, and duplicate times used once; all of this is counted.
///
/// Calibrations of a camera and an IMU, as several tools write them: EuRoC's sensor.yaml, Kalibr's
/// and OpenVINS's camchain and IMU, ROS's camera_info, OpenCV, ORB-SLAM, VINS (camodocal).
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/pose.h"
#include "sim/imu/imu.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"

namespace lcs::replay {

/// Camera frame C with x right, y down, z ahead; the world frame is the file's own.
struct PosesFile {
  struct Line {
    std::optional<std::int64_t> t_ns;   ///< if `timed`
    std::optional<std::size_t> number;  ///< of the picture, if `numbered`
    sim::Pose T_WC;                     ///< `of_body`: T_WB
  };
  /// In file order; an unreadable line is empty, so that the others keep their index.
  std::vector<std::optional<Line>> lines;
  bool timed = false;
  bool numbered = false;  ///< each line states its picture (KITTI-360)
  bool of_body = false;   ///< EuRoC's columns p_RS_R_x ...: poses of the body, not of the camera
};

/// Lines of 8 numbers (TUM: t x y z qx qy qz qw), 12 or 16 (rows of a matrix; KITTI), 17 (the
/// picture's number before 16; KITTI-360), or a table whose header names position, quaternion and
/// time. Counts unreadable lines.
/// \param time_unit s, ms, us or ns; "": as the header states it, or s (TUM), ns (EuRoC).
/// \throws input::Error for a file that is unreadable, without a pose, or in another format.
PosesFile read_poses(const fs::path& file, const std::string& time_unit, Tally& tally);

/// A rotation close to a rounded rotation matrix; absent if it is no rotation.
std::optional<Eigen::Matrix3d> rotation_of(const Eigen::Matrix3d& R);

/// Columns are as in EuRoC, or have other usual names (ROS, Kalibr, loggers of phones), with
/// units in the header; without a header: time, angular rates in rad/s, accelerations in m/s^2.
/// \param places of the angular rates and accelerations without a header.
/// \throws input::Error if the file is unreadable, has no reading, or has readings that no IMU can
/// have: rates in deg/s, accelerations in g or without gravity, the two interchanged.
std::vector<sim::ImuSample> read_imu_csv(const fs::path& file, const TableTimes& times,
                                         Tally& tally,
                                         const std::array<std::size_t, 6>& places = {1, 2, 3, 4, 5,
                                                                                     6});

/// Yaw rates are in an optional fifth column.
std::vector<sim::OdometrySample> read_odometry_csv(const fs::path& file, const TableTimes& times,
                                                   Tally& tally);

/// Exact poses of the camera, as written by `lcs generate`.
CameraPoses read_pose_csv(const fs::path& file, Tally& tally);

/// \param has_velocities with biases, as EuRoC; else from poses alone (columns of EuRoC up to
/// q_RS_z):
///   velocities are their differences, biases are 0; both is told.
std::vector<TrueState> read_truth_csv(const fs::path& file, const TableTimes& times,
                                      bool has_velocities, Tally& tally);

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
SensorCalibration read_calibration(const fs::path& file, const std::string& camera = "");

}  // namespace lcs::replay
