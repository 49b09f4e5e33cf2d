/// \file
/// What a camera of the model sees: colour, z-depth and the geom under each pixel. Owns MuJoCo's
/// renderer and the GL context; to be used from the thread that made it.
#pragma once

#include <memory>
#include <opencv2/core.hpp>

#include "sim/model.h"

namespace lcs::sim {

/// Pixels are top row first. Shadows and reflections are never drawn, and the headlight is ambient
/// only: such things do not move with the surface on which they are seen, so that the truth would
/// be wrong for a corner on them.
class CameraRenderer {
 public:
  /// Writes the camera's needs (buffer size, clipping planes, lights) into the model first.
  /// \param model outlives the renderer; textures must be complete, as they are uploaded here.
  /// \throws std::runtime_error if GL does not start or the image is larger than it can render.
  CameraRenderer(Model& model, int camera, int width_px, int height_px);
  ~CameraRenderer();
  CameraRenderer(const CameraRenderer&) = delete;
  CameraRenderer& operator=(const CameraRenderer&) = delete;

  /// Takes over the poses of the model's last forward pass for the renders that follow.
  /// \throws MujocoError if the scene has more to draw than there is room for.
  void update();

  void render_colour(cv::Mat3b& bgr);
  /// \param depth_m along the optical axis; +inf where there is nothing.
  /// \param geom id in the model, -1 where there is nothing. Both without multisampling.
  void render_depth_and_geoms(cv::Mat1f& depth_m, cv::Mat1i& geom);

  double near_m() const;  ///< what is nearer than this to the camera's plane is not drawn

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs::sim
