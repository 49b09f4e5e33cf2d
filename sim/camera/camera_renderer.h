/// \file
/// Renders colour, z-depth and geom ids from a camera of the model. Owns MuJoCo's renderer and the
/// GL context; use it only from the thread that constructed it.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "sim/camera/drawables.h"
#include "sim/pose.h"

namespace lcs::sim {

/// Images are top row first. Shadows, reflections and the headlight's directional part are off:
/// they move over surfaces, so that the true motion would be wrong for a corner on them.
class CameraRenderer {
 public:
  /// Writes buffer size, clipping planes and lights into the model.
  /// \param model must outlive the renderer; its textures must be complete: they are uploaded here.
  /// \throws std::runtime_error if GL does not start or cannot render images of this size.
  CameraRenderer(Model& model, int camera, int width_px, int height_px,
                 const GeomGroups& groups = kUsualGroups);
  ~CameraRenderer();
  CameraRenderer(const CameraRenderer&) = delete;
  CameraRenderer& operator=(const CameraRenderer&) = delete;

  /// Sees by this pinhole from the next update on; before, by the field of view of the model's
  /// camera, with the principal point in the middle.
  /// \param view of the size of the renderer.
  void set_view(const Pinhole& view);

  /// Takes the poses of the model's last forward pass for the following renders.
  void update();

  /// The picture before the lens. Its pixels belong to the geoms of `render_depth_and_geoms`.
  void render_colour(cv::Mat3b& bgr);
  /// The picture behind the lens, whose point spread mixes neighbouring pixels.
  static void blur(const cv::Mat3b& sharp, cv::Mat3b& picture);
  /// \param depth_m z-depth along the optical axis, m; +inf for the background.
  /// \param geom geom id in the model, -1 for the background. Both without multisampling.
  void render_depth_and_geoms(cv::Mat1f& depth_m, cv::Mat1i& geom);

  double near_m() const;            ///< z of the near clipping plane
  std::string gl_renderer() const;  ///< as `GlContext::renderer`

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs::sim
