/// \file
/// Camera poses in a text file of TUM's RGB-D benchmark or KITTI's odometry.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "sim/pose.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

/// Camera frame C with x right, y down, z ahead; the world frame is the file's own.
struct PosesFile {
  struct Line {
    std::optional<std::int64_t> t_ns;  ///< in TUM's format only
    sim::Pose T_WC;
  };
  /// In file order; an unreadable line is empty, so that the others keep their index.
  std::vector<std::optional<Line>> lines;
  bool timed = false;  ///< "t x y z qx qy qz qw" instead of the three rows of a matrix
};

/// Counts unreadable lines. \throws input::Error for a file that is unreadable, without a pose,
/// or in another format.
PosesFile read_poses(const std::filesystem::path& file, Tally& tally);

/// A rotation close to a rounded rotation matrix; absent if it is no rotation.
std::optional<Eigen::Matrix3d> rotation_of(const Eigen::Matrix3d& R);

/// Up (against gravity) in the poses' world frame, from the given mounting of the camera on a
/// vehicle that is upright at the first pose. \param otherwise result without a given mounting.
std::optional<Eigen::Vector3d> up_of_world(const scenario::Recorded& asked,
                                           const sim::Pose& T_WC_first,
                                           const std::optional<Eigen::Vector3d>& otherwise);

}  // namespace lcs::replay
