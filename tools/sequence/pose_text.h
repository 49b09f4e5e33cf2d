/// \file
/// Poses in text formats. Numbers have the shortest form that reads back to the same bits.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>

#include "sim/pose.h"

namespace lcs::sequence {

/// The unit quaternion of a pose's rotation, with w >= 0 so that it is unique.
Eigen::Quaterniond quaternion_of(const sim::Pose& pose);

/// The 4x4 matrix row by row, with the last row 0 0 0 1.
std::array<double, 16> matrix_of(const sim::Pose& pose);
/// \throws std::invalid_argument unless it is a rigid transform, to 1e-6.
sim::Pose pose_of(const std::array<double, 16>& matrix);

}  // namespace lcs::sequence
