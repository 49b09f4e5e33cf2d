/// \file
/// Poses in a text file: of TUM's RGB-D benchmark, KITTI's odometry, KITTI-360, EuRoC's truth.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/pose.h"
#include "tools/replay/recorded.h"

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

}  // namespace lcs::replay
