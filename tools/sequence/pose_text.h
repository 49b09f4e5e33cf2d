/// \file
/// Poses and lenses in text formats. Numbers have the shortest form that reads back to the same
/// bits.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "sim/base/optics.h"

namespace lcs::sequence {

/// Numbers with a separator between them.
std::string numbers(std::span<const double> values, const char* separator);

/// Seconds with nine digits after the point. \param t_ns >= 0.
std::string seconds(std::int64_t t_ns);

/// What an IMU's reading is the reading of, for a comment in a file: without a line break.
std::string reading_text(const scenario::Imu& imu);

/// The coefficients of a distortion as Kalibr has them: four, zeros if there is none. A k3 other
/// than 0, which Kalibr's radtan lacks, is the fifth.
std::vector<double> four_coefficients(const sim::Lens& lens);

/// TUM's line, `t x y z qx qy qz qw`, with its end.
std::string pose_line(std::int64_t t_ns, const sim::Pose& pose);

/// The unit quaternion of a pose's rotation, with w >= 0. The documents of a sequence keep the sign
/// from row to row (`DocumentPart::poses_between`).
Eigen::Quaterniond quaternion_of(const sim::Pose& pose);

/// The 4x4 matrix row by row, with the last row 0 0 0 1.
std::array<double, 16> matrix_of(const sim::Pose& pose);
/// \throws std::invalid_argument unless it is a rigid transform, to 1e-6.
sim::Pose pose_of(const std::array<double, 16>& matrix);

}  // namespace lcs::sequence
