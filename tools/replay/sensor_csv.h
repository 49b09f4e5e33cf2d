/// \file
/// Tables of sensors as EuRoC's ASL has them: IMU, truth, pictures. Rows that cannot be read are
/// left out, rows out of order are sorted, times that come twice are used once; all of it is
/// counted.
#pragma once

#include <filesystem>
#include <vector>

#include "sim/imu.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"

namespace lcs::replay {

/// \throws std::runtime_error if the file cannot be read, or holds no reading.
std::vector<sim::ImuSample> read_imu_csv(const std::filesystem::path& file, Tally& tally);

/// Yaw rates are those of a fifth column, where there is one.
std::vector<sim::OdometrySample> read_odometry_csv(const std::filesystem::path& file, Tally& tally);

/// Exact poses of the camera, as `lcs generate` writes them.
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

/// Counts the gaps between readings that are longer than four of their usual periods.
void count_gaps(const std::vector<sim::ImuSample>& samples, Tally& tally);

}  // namespace lcs::replay
