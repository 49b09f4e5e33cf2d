/// \file
/// Recorded pictures of a scene, and streams of as many corners as are asked for from them.
///
/// A picture of 640x480 shows some hundred corners. The streams keep that density and change the
/// picture's size: the recorded picture, repeated to all sides, is seen through a window that shows
/// the number of corners asked for on average. The camera moves sideways and does not turn, so that
/// all that is static moves alike in all tiles, and a stream is what a larger camera would see of a
/// world that repeats itself. Where tiles meet, corners come and go as at an image's border.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/signature.h"
#include "scenarios/scenario.h"

namespace lcs::bench {

/// A scenario as the camera and the IMU see it, rendered once.
struct Footage {
  explicit Footage(const std::string& scenario_file);

  scenario::Scenario scenario;
  Intrinsics camera;
  std::vector<cv::Mat3b> images;   ///< BGR
  std::vector<EgoMotion> motions;  ///< since the frame before
  double corners_per_px = 0;       ///< mean
};

class Stream {
 public:
  /// \param footage outlives the stream. \param corners a frame, on average.
  Stream(const Footage& footage, int corners);

  std::size_t size() const { return corners_px_.size(); }
  const Intrinsics& camera() const { return camera_; }
  const std::vector<Eigen::Vector2f>& corners_px(std::size_t frame) const {
    return corners_px_[frame];
  }
  const std::vector<Signature>& signatures(std::size_t frame) const { return signatures_[frame]; }
  const EgoMotion& motion(std::size_t frame) const { return footage_->motions[frame]; }
  double mean_corners() const;

  /// Made anew with each call: they are large.
  cv::Mat3b image(std::size_t frame) const;
  cv::Mat1b grey(std::size_t frame) const;

 private:
  const Footage* footage_;
  Intrinsics camera_;
  std::vector<std::vector<Eigen::Vector2f>> corners_px_;
  std::vector<std::vector<Signature>> signatures_;
};

}  // namespace lcs::bench
