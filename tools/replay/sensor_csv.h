/// \file
/// Sensor tables in EuRoC's ASL format: IMU, truth, pictures. Unreadable rows are left out, rows
/// out of order sorted, and duplicate times used once; all of this is counted.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <vector>

#include "sim/imu/imu.h"
#include "tools/replay/at_rest.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {

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
std::vector<SensorReadings::CameraPose> read_pose_csv(const fs::path& file, Tally& tally);

std::vector<TrueState> read_truth_csv(const fs::path& file, const TableTimes& times, Tally& tally);
/// As above, from poses alone (columns of EuRoC up to q_RS_z): velocities are their differences,
/// biases are 0; both is told.
std::vector<TrueState> read_body_poses_csv(const fs::path& file, const TableTimes& times,
                                           Tally& tally);

}  // namespace lcs::replay
