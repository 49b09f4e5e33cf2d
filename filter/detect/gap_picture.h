/// \file
/// Looks at gaps below circles in the camera's pictures: does the gap move as the ground does, or
/// as the body of the circle?
#pragma once

#include <opencv2/core.hpp>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/types/gap.h"

namespace lcs {

/// Keeps the last few pictures, blurred, with the motions between them. Same bits on any machine.
class GapPicture : public GapView {
 public:
  explicit GapPicture(const Intrinsics& camera) : camera_(camera) {}

  /// The picture of the coming frame, without distortion. \throws std::invalid_argument if it is
  ///   not of the camera's size.
  void show(const cv::Mat1b& grey);

  void begin(const EgoMotion& motion) override;

  /// Warps an earlier picture to this frame, once as the ground moves and once as the body does,
  /// and compares both with the present picture, row by row. Rows without a contour count for the
  /// ground: a body without any is rare.
  std::optional<double> evidence(const Gap& gap) override;

  /// A picture of an earlier frame. A point X of this frame is at `R X + t` there, m.
  struct Earlier {
    cv::Mat1b blurred;
    Eigen::Matrix3d R;
    Eigen::Vector3d t_m;
  };

 private:
  Intrinsics camera_;
  cv::Mat1b shown_;
  cv::Mat1b now_;                 // blurred
  std::vector<Earlier> earlier_;  // latest first
  std::optional<Ground> ground_;
};

}  // namespace lcs
