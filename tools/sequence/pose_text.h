/// \file
/// Poses as the text formats have them. Numbers are in the shortest form that reads back to the
/// same bits.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <string>

#include "sim/pose.h"

namespace lcs::sequence {

/// The rotation of a pose, unit, with w >= 0: of the two quaternions that mean the same, one.
Eigen::Quaterniond quaternion_of(const sim::Pose& pose);

/// Row by row, with the last row 0 0 0 1.
std::array<double, 16> matrix_of(const sim::Pose& pose);
/// \throws std::invalid_argument unless it is a rigid transform, to 1e-6.
sim::Pose pose_of(const std::array<double, 16>& matrix);

}  // namespace lcs::sequence
