/// \file
/// From any lens to a pinhole with square pixels, which is what detectors know. Corners are found
/// in the picture as it was taken, and taken to where the pinhole would have seen them, to the
/// digit; only for those who look at pictures is the picture itself straightened, which blurs it.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/pose.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

class Rectifier {
 public:
  /// \throws scenario::Error for a distortion that no lens has.
  Rectifier(const Lens& lens, cv::Size size_px);

  /// The pinhole: the lens's principal point, and the mean of its focal lengths.
  const sim::Pinhole& camera() const { return camera_; }

  /// A lens without distortion and with square pixels, which leaves all as it is, bit by bit.
  bool is_pinhole() const { return map_x_.empty(); }

  /// Leaves out corners that the pinhole does not see, or that the lens has no straight ray for.
  void rectify(std::vector<Eigen::Vector2f>& corners_px) const;
  void rectify(cv::Mat3b& picture) const;
  /// Replaces a box, given by pixel edges, by the box round its rectified outline.
  void rectify(double& left, double& top, double& right, double& bottom) const;

 private:
  double covered() const;
  std::vector<cv::Point2f> straight(const std::vector<cv::Point2f>& bent) const;
  std::vector<cv::Point2f> bent(const std::vector<cv::Point2f>& straight) const;

  bool is_equidistant_;
  cv::Matx33d from_, to_;
  cv::Mat coefficients_;
  sim::Pinhole camera_;
  cv::Mat map_x_, map_y_;  ///< empty for a lens that is a pinhole
};

}  // namespace lcs::replay
