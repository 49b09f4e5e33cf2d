/// \file
/// Cameras with a lens: their intrinsics and distortion, and the exact projection through them.
///
/// Camera frame and pixels as in `Pinhole`. The ray of a pixel is (x, y, 1) in C.
#pragma once

#include <Eigen/Geometry>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/pose.h"

namespace lcs::sim {

/// A calibrated camera, in pixels with (0, 0) at the centre of the top-left one.
struct Lens {
  enum class Distortion { none, radial_tangential, equidistant };
  double fu_px = 0, fv_px = 0, cu_px = 0, cv_px = 0;
  Distortion distortion = Distortion::none;
  std::vector<double> coefficients;  ///< in OpenCV's order
  /// The rays pass a unit sphere before the pinhole. Mei and Rives, ICRA 2007 (omni): xi, with
  /// `alpha` 0. Usenko et al., 3DV 2018 (double sphere): xi and alpha. 0, 0: a pinhole alone.
  double xi = 0, alpha = 0;
  bool centred = false;             ///< the principal point is the centre of the picture
  int width_px = 0, height_px = 0;  ///< picture size of the calibration; 0: unknown
  input::Source source = {};        ///< place to name if the picture size differs

  /// Whether pixels are square and straight lines stay straight.
  bool is_pinhole() const;
  /// The pinhole with square pixels that detectors work in: it has the lens's principal point and
  /// the mean of its focal lengths.
  Pinhole pinhole() const;
};

/// The lens of a scenario's camera.
Lens lens_of(const scenario::Camera& camera);
/// Gives a lens the distortion of a scenario.
void set_distortion(const scenario::Distortion& distortion, Lens& lens);

/// The exact projection of a camera: a pinhole, or a lens with a distortion of OpenCV's models
/// "pinhole" (k1, k2, p1, p2, k3) or "fisheye" (k1 to k4). No spheres.
class Optics {
 public:
  Optics() = default;
  Optics(const Pinhole& camera);  // NOLINT(google-explicit-constructor): a pinhole is optics
  /// Computes the ray of every pixel.
  /// \param lens with the size of its pictures.
  /// \throws input::Error if a pixel has no unique ray before the camera.
  explicit Optics(const Lens& lens);

  const Lens& lens() const { return lens_; }
  bool is_pinhole() const { return rays_.empty(); }
  cv::Size size_px() const { return {lens_.width_px, lens_.height_px}; }

  /// Pixel of a point with z > 0, in C; NaN where the distortion has folded back.
  Eigen::Vector2d project(const Eigen::Vector3d& x_C) const;
  /// Point in C at z-depth `depth_m` on the ray of any place in the picture; NaN without a ray.
  Eigen::Vector3d back_project(const Eigen::Vector2d& px, double depth_m) const;
  /// The ray (x, y) of a pixel of the picture.
  Eigen::Vector2d ray(int x, int y) const;
  /// Derivative of the pixel by its ray, px.
  Eigen::Matrix2d jacobian_px(const Eigen::Vector2d& ray) const;

 private:
  Eigen::Vector2d bent(const Eigen::Vector2d& ray) const;
  double grows(double radius) const;
  std::optional<Eigen::Vector2d> straight(const Eigen::Vector2d& px) const;

  Lens lens_;
  Eigen::Vector2d focal_px_ = Eigen::Vector2d::Zero(), centre_px_ = Eigen::Vector2d::Zero();
  double most_radius_ = 0;  ///< of a ray, up to which the distortion grows with it
  cv::Mat2d rays_;          ///< by pixel; empty for a pinhole
};

}  // namespace lcs::sim
