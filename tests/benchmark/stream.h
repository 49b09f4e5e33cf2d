/// \file
/// Recorded pictures of a scene, and streams with a requested number of corners made from them.
///
/// A picture of 640x480 has some hundred corners. The streams keep that density and change the
/// picture's size: the recorded picture is repeated to all sides, and a window shows the requested
/// number of corners on average. The camera moves sideways without turning, so all static points
/// move equally in all tiles, and a stream equals the picture of a larger camera in a periodic
/// world. Where tiles meet, corners appear and vanish as at an image's border.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/types/signature.h"
#include "scenarios/scenario.h"

namespace lcs::test {

/// The pictures and motions of a scenario, rendered once.
struct Footage {
  explicit Footage(const std::string& scenario_file);

  scenario::Scenario scenario;
  Intrinsics camera;
  std::vector<cv::Mat3b> images;   ///< BGR
  std::vector<EgoMotion> motions;  ///< since the previous frame
  double corners_per_px = 0;       ///< mean
};

class Stream {
 public:
  /// \param footage must outlive the stream. \param corners mean number per frame.
  Stream(const Footage& footage, int corners);

  std::size_t size() const { return corners_px_.size(); }
  const Intrinsics& camera() const { return camera_; }
  const std::vector<Eigen::Vector2f>& corners_px(std::size_t frame) const {
    return corners_px_[frame];
  }
  const std::vector<Signature>& signatures(std::size_t frame) const { return signatures_[frame]; }
  const EgoMotion& motion(std::size_t frame) const { return footage_->motions[frame]; }
  double mean_corners() const;

  /// Computed anew in each call, because they are large.
  cv::Mat3b image(std::size_t frame) const;
  cv::Mat1b grey(std::size_t frame) const;

 private:
  const Footage* footage_;
  Intrinsics camera_;
  std::vector<std::vector<Eigen::Vector2f>> corners_px_;
  std::vector<std::vector<Signature>> signatures_;
};

}  // namespace lcs::test
