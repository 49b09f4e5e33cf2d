/// \file
/// Sensor tables in EuRoC's ASL format: IMU, truth, pictures. Unreadable rows are left out, rows
/// out of order sorted, and duplicate times used once; all of this is counted.
#pragma once

#include <filesystem>
#include <vector>

#include "sim/imu/imu.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"

namespace lcs::replay {

/// \throws std::runtime_error if the file is unreadable or has no reading.
std::vector<sim::ImuSample> read_imu_csv(const std::filesystem::path& file, Tally& tally);

/// Yaw rates are in an optional fifth column.
std::vector<sim::OdometrySample> read_odometry_csv(const std::filesystem::path& file, Tally& tally);

/// Exact poses of the camera, as written by `lcs generate`.
std::vector<SensorReadings::CameraPose> read_pose_csv(const std::filesystem::path& file,
                                                      Tally& tally);

/// State of the body, with the biases of its IMU.
struct TrueState {
  std::int64_t t_ns = 0;
  NavigationState state;
  Eigen::Vector3d gyro_bias_radps = Eigen::Vector3d::Zero();
  Eigen::Vector3d accel_bias_mps2 = Eigen::Vector3d::Zero();
};
std::vector<TrueState> read_truth_csv(const std::filesystem::path& file, Tally& tally);

/// Counts gaps between readings that exceed four of their usual periods.
void count_gaps(const std::vector<sim::ImuSample>& samples, Tally& tally);

}  // namespace lcs::replay
