/// \file
/// Renders the picture of a camera with any optics, and its depth and geom ids.
///
/// A pixel is the mean of the light that falls on it, by `samples` of it: 1, 4, 5 or 9. They are
/// the points of a square lattice, rendered as the pixels of one large picture. The lattice of 5 is
/// turned by atan(1/2) against the pixels, so that the samples of a pixel have five places along
/// its rows and five along its columns, a fifth of a pixel apart:
///
///       .  x  .  .  .
///       .  .  .  .  x          pixel (x, y) has the lattice points
///       .  .  x  .  .            (2x - y, x + 2y) + {(0, 0), (+-1, 0), (0, +-1)}
///       x  .  .  .  .
///       .  .  .  x  .
///
/// An upright or level edge is then in place to a fifth of a pixel; with 4 or 9 samples, whose
/// lattice is not turned, to a half or a third.
#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "sim/base/optics.h"
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

/// Renders colour codes, z-depth and geom ids from a camera of the model. Owns MuJoCo's renderer
/// and the GL context; use it only from the thread that constructed it.
///
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

/// * light: the mean of the lattice points that lie in the pixel. A lens's picture is made from a
///   pinhole's lattice on the same axis that sees all of its field of view, as dense as a pinhole's
///   in the part of the picture that needs most, and denser elsewhere;
/// * depth and geom, in the middle of each pixel: of a pinhole, rendered there. Of a lens: the geom
///   of the nearest point, at most .71 / sqrt(samples) of a pixel away, and the depth of that point
///   continued to the ray along the surface, which is exact on planes.
class LensRenderer {
 public:
  /// \param camera of the model; \param optics of its picture. As `CameraRenderer`.
  /// \param samples of each pixel: 1, 4, 5 or 9. \throws std::invalid_argument for others
  /// \throws input::Error if the lattice would be too large.
  LensRenderer(Model& model, int camera, const Optics& optics, int samples = 5,
               const GeomGroups& groups = kUsualGroups, bool has_shadows = false);

  void update() { renderer_.update(); }
  /// The mean of each pixel's samples in linear light, BGR, before lens blur, lamps and sensor.
  void render_light(cv::Mat3f& light);
  /// The same with the shadows of lights that have `castshadow`. \param even, geom without them, by
  /// the other functions. \param edge receives 1 within `kShadowEdge_px` of the edges of shadows.
  void render_shaded(const cv::Mat3f& even, const cv::Mat1i& geom, cv::Mat3f& shaded,
                     cv::Mat1i& edge);
  /// As `CameraRenderer`, for each pixel of the picture.
  void render_depth_and_geoms(cv::Mat1f& depth_m, cv::Mat1i& geom);
  double near_m() const { return renderer_.near_m(); }
  std::string gl_renderer() const { return renderer_.gl_renderer(); }

 private:
  /// The lattice, and each pixel's points in it.
  struct Sampling {
    View view;
    /// Indices in the rendered codes, pixel by pixel; those of pixel i are before the i + 1st end.
    std::vector<int> points, ends;
    cv::Mat2f middles;  ///< place in the view of each pixel's middle; empty for a pinhole
  };
  static Sampling sampling_of(const Optics& optics, int samples);
  void mean_of_samples(const cv::Mat4w& codes, cv::Mat3f& light) const;

  cv::Size size_px_;
  Sampling sampling_;
  CameraRenderer renderer_;
};

/// Makes pictures with MuJoCo's shadow maps usable. Their texels leave speckles on lit surfaces: a
/// pixel takes the median share of light of the pixels of its geom in the 5 x 5 round it. Pixels
/// beside another geom, which mix two surfaces, keep their share. Shadows below 3 px in width are
/// lost.
/// \param even linear light without shadows, \param shaded the same with them, changed in place.
/// \param geom of each pixel's middle, -1 for the background.
/// \return 1 at the edges of shadows: at neighbouring pixels of a geom that keep shares of their
///   light that differ by more than 9 %.
cv::Mat1b clean_shadows(const cv::Mat3f& even, const cv::Mat1i& geom, cv::Mat3f& shaded);

}  // namespace lcs::sim
