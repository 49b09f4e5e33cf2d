/// \file
/// Converts any lens to a pinhole with square pixels, as detectors assume. Corners are found in the
/// original picture and then moved to their exact pinhole positions. The picture itself, which
/// rectification blurs, is rectified only for detectors and viewers that need it.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/base/optics.h"
#include "sim/truth/truth.h"

namespace lcs::sim {

class Rectifier {
 public:
  /// \throws input::Error for an implausible distortion.
  Rectifier(const Lens& lens, cv::Size size_px);

  /// The pinhole has the lens's principal point and the mean of its focal lengths.
  const Pinhole& camera() const { return camera_; }

  /// The lens has no distortion and square pixels; rectification then changes no bit.
  bool is_pinhole() const { return map_x_.empty(); }

  /// Removes corners outside the pinhole's picture, and those without a unique ray.
  void rectify(std::vector<Eigen::Vector2f>& corners_px) const;
  void rectify(cv::Mat& picture) const;  ///< BGR or grey
  /// \name Truth of each pixel, by the nearest pixel; -1 and +inf where the picture shows nothing.
  ///@{
  void rectify(cv::Mat1i& ids) const;
  void rectify(cv::Mat1f& depth_m) const;
  ///@}
  /// Boxes and masks in the pinhole's picture, without objects that it does not show.
  /// \param objects by id. \param ids of the picture, as `FrameTruth::object`
  std::vector<ObjectTruth> rectified(const std::vector<ObjectTruth>& objects,
                                     const cv::Mat1i& ids) const;
  /// Replaces a box, in pixel edges, by the bounding box of its rectified outline.
  void rectify(double& left, double& top, double& right, double& bottom) const;

 private:
  void remap(cv::Mat& picture, int interpolation, int border, double beyond = 0) const;
  double covered() const;
  std::vector<cv::Point2f> straight(const std::vector<cv::Point2f>& bent) const;
  std::vector<cv::Point2f> bent(const std::vector<cv::Point2f>& straight) const;

  bool is_spherical() const { return xi_ != 0 || alpha_ != 0; }
  Eigen::Vector3d onto_sphere(const Eigen::Vector3d& ray) const;
  Eigen::Vector3d from_sphere(double x, double y) const;
  void map_by_points();

  bool is_equidistant_;
  cv::Matx33d from_, to_;
  cv::Mat coefficients_;
  double xi_, alpha_;  ///< as in `Lens`
  Pinhole camera_;
  cv::Mat map_x_, map_y_;  ///< empty for a pinhole lens
};

}  // namespace lcs::sim
