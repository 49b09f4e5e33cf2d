/// \file
/// KITTI's cameras: their folders, and their calibration files, one "NAME: numbers" a line.
#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "sim/base/pose.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

/// The asked camera, or else the first of the names that is a folder, or else `otherwise`.
std::string kitti_camera(const scenario::RecordingSource& asked, std::span<const char* const> names,
                         const char* otherwise);

class KittiCalibration {
 public:
  /// Lines without a name are called P0, P1, ... \throws input::Error if it cannot be read.
  explicit KittiCalibration(const fs::path& file);

  /// \name Access to a line. \throws input::Error if it is missing or has another length.
  ///@{
  const std::vector<double>& numbers(const std::string& name, std::size_t count) const;
  /// \throws input::Error also for a matrix that is no rotation.
  Eigen::Matrix3d rotation(const std::string& name) const;
  /// The transform of a line with 12 numbers, three rows of a matrix.
  sim::Pose pose(const std::string& name) const;
  /// The transform of the lines R and T.
  sim::Pose pose() const;
  /// K of the projection [K | K t] of rectified pictures, in pixels, with their size if S_rect_NN
  /// states it.
  Lens lens(const std::string& name) const;
  /// t of that projection: transforms points from the common rectified frame to the camera.
  sim::Pose beside(const std::string& name) const;
  ///@}

 private:
  fs::path file_;
  std::map<std::string, std::vector<double>> values_;
};

}  // namespace lcs::replay
