/// \file
/// Renders colour codes, z-depth and geom ids from a camera of the model. Owns MuJoCo's renderer
/// and the GL context; use it only from the thread that constructed it.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>

#include "sim/base/pose.h"
#include "sim/scene/drawables.h"

namespace lcs::sim {

/// A pinhole on the axis of the model's camera, whose picture is turned about that axis.
struct View {
  Pinhole pinhole;
  /// From the camera's right to the right of the view's picture, towards the camera's top.
  double roll_rad = 0;
  /// Least and most (x, y) of the rays (x, y, 1) in C that are used; others may stay undrawn.
  std::optional<Eigen::AlignedBox2d> used;
};

/// Reflections, highlights and the headlight's directional part are off,
/// and shadows unless asked for: they move over surfaces, so that the true motion would be wrong
/// for a corner on them. Cylinders are drawn as prisms of 64 sides.
class CameraRenderer {
 public:
  /// Writes buffer size, clipping planes and lights into the model.
  /// \param model must outlive the renderer; its textures must be complete: they are uploaded here.
  /// \param colour view of the colour codes, \param truth view of depth and ids.
  /// \throws std::runtime_error if GL does not start or cannot render images of this size.
  CameraRenderer(Model& model, int camera, const View& colour, const View& truth,
                 const GeomGroups& groups = kUsualGroups, bool has_shadows = false);
  ~CameraRenderer();

  /// Takes the poses of the model's last forward pass for the following renders.
  void update();

  /// sRGB codes of 16 bits of the colour view, its bottom row first: red, green, blue, and a value
  /// without meaning. One sample in the middle of each pixel. Valid until the next render.
  /// \param has_shadows draws the shadows of the lights that have `castshadow`, from shadow maps.
  const cv::Mat4w& render_codes(bool has_shadows = false);
  /// Of the truth view, its top row first, in the middle of each pixel.
  /// \param depth_m z-depth along the optical axis, m; +inf for the background.
  /// \param geom geom id in the model, -1 for the background.
  void render_depth_and_geoms(cv::Mat1f& depth_m, cv::Mat1i& geom);

  double near_m() const;            ///< z of the near clipping plane
  std::string gl_renderer() const;  ///< as `GlContext::renderer`

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs::sim
