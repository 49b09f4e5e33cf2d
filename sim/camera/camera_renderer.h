/// \file
/// Renders colour, z-depth and geom ids from a camera of the model. Owns MuJoCo's renderer and the
/// GL context; use it only from the thread that constructed it.
#pragma once

#include <memory>
#include <opencv2/core.hpp>
#include <string>

#include "sim/base/pose.h"
#include "sim/scene/drawables.h"

namespace lcs::sim {

/// Images are top row first. Reflections and the headlight's directional part are off, and shadows
/// but in `render_shaded`: they move over surfaces, so that the true motion would be wrong for a
/// corner on them.
class CameraRenderer {
 public:
  /// Writes buffer size, clipping planes and lights into the model.
  /// \param model must outlive the renderer; its textures must be complete: they are uploaded here.
  /// \throws std::runtime_error if GL does not start or cannot render images of this size.
  CameraRenderer(Model& model, int camera, int width_px, int height_px,
                 const GeomGroups& groups = kUsualGroups, bool has_shadows = false);
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
  /// The same with the shadows of the lights that have `castshadow`, from shadow maps. Their texels
  /// leave speckles on lit surfaces: a pixel takes the median share of light of the pixels of its
  /// geom in the 5 x 5 round it. Shadows below 3 px in width are lost. \param even,geom of
  /// `render_colour` and `render_depth_and_geoms`. \param edge receives 1 at the edges of shadows:
  /// at neighbouring pixels of a geom that keep shares of their light that differ by more than 4 %,
  /// beyond the rounding of both pictures to grey levels.
  void render_shaded(const cv::Mat3b& even, const cv::Mat1i& geom, cv::Mat3b& bgr, cv::Mat1b& edge);
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
