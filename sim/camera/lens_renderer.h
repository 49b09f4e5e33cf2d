/// \file
/// Renders the picture of a camera with any optics, and its depth and geom ids.
#pragma once

#include "sim/base/optics.h"
#include "sim/camera/camera_renderer.h"

namespace lcs::sim {

/// A pinhole is rendered as it is, whatever its principal point. A lens is resampled from a pinhole
/// on the same axis that sees all of its field of view, with at least `kDensity` pixels to each
/// pixel of the lens, in both directions:
///
/// * colour: the mean of 2 x 2 samples in each pixel, each linear between its four neighbours. That
///   spreads a point by less than 0.4 px (standard deviation), beside the 0.6 px of `blur`;
/// * geom: from the pinhole's pixel nearest to the ray, which is at most 1 / (2 kDensity) of a
///   pixel of the lens away along each axis;
/// * depth: of that pixel, continued to the ray along the surface. Exact on planes.
class LensRenderer {
 public:
  static constexpr double kDensity = 2;

  /// \param camera of the model; \param optics of its picture. As `CameraRenderer`.
  /// \throws input::Error if the pinhole would be too large.
  LensRenderer(Model& model, int camera, const Optics& optics,
               const GeomGroups& groups = kUsualGroups, bool has_shadows = false);

  /// The picture with shadows, and 1 within `kShadowEdge_px` of their edges.
  void render_shaded(cv::Mat3b& bgr, cv::Mat1i& edge);

  /// \name As in `CameraRenderer`.
  ///@{
  void update() { renderer_.update(); }
  void render_colour(cv::Mat3b& bgr);
  void render_depth_and_geoms(cv::Mat1f& depth_m, cv::Mat1i& geom);
  double near_m() const { return renderer_.near_m(); }
  std::string gl_renderer() const { return renderer_.gl_renderer(); }
  ///@}

 private:
  LensRenderer(Model& model, int camera, const Optics& optics, const GeomGroups& groups,
               bool has_shadows, const cv::Mat2d& rays);
  void resample(cv::Mat3b& bgr) const;

  Optics optics_;
  Pinhole view_;       ///< rendered
  cv::Mat2f centres_;  ///< place in the view of each pixel; empty if the view is the picture
  cv::Mat2f samples_;  ///< likewise of 2 x 2 samples in each pixel
  CameraRenderer renderer_;
};

}  // namespace lcs::sim
