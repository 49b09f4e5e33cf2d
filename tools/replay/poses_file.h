/// \file
/// Poses of a camera in a text file, as TUM's RGB-D benchmark or KITTI's odometry has them.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <vector>

#include "sim/pose.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

/// Camera frame C with x right, y down, z ahead, in a world of the file's own.
struct PosesFile {
  struct Line {
    std::optional<std::int64_t> t_ns;  ///< of TUM's
    sim::Pose T_WC;
  };
  /// In the order of the file; none for a line that cannot be read, so that others keep their
  /// place.
  std::vector<std::optional<Line>> lines;
  bool timed = false;  ///< "t x y z qx qy qz qw", and not three rows of a matrix
};

/// Lines that cannot be read are counted. \throws scenario::Error for a file that cannot be read,
/// without a pose, or of other lines.
PosesFile read_poses(const std::filesystem::path& file, Tally& tally);

/// The rotation that a matrix is but for its digits; none if it is no rotation.
std::optional<Eigen::Matrix3d> rotation_of(const Eigen::Matrix3d& R);

/// Against gravity in the world of the poses: by the camera's mount on a vehicle that stands
/// upright at the first pose, where the user gives it. \param otherwise where that is not given.
std::optional<Eigen::Vector3d> up_of_world(const scenario::Recorded& asked,
                                           const sim::Pose& T_WC_first,
                                           const std::optional<Eigen::Vector3d>& otherwise);

}  // namespace lcs::replay
