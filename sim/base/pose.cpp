#include "sim/base/pose.h"

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lcs::sim {

Pinhole Pinhole::from_fovy(int width_px, int height_px, double fovy_rad) {
  if (width_px <= 0 || height_px <= 0) {
    throw std::invalid_argument("a camera needs a positive width and height");
  }
  if (!(fovy_rad > 0 && fovy_rad < std::numbers::pi)) {
    throw std::invalid_argument("the vertical field of view must lie between 0 and 180 deg");
  }
  const double focal_px = height_px / 2.0 / std::tan(fovy_rad / 2);
  const Eigen::Vector2d centre_px((width_px - 1) / 2.0, (height_px - 1) / 2.0);
  return {focal_px, centre_px, width_px, height_px};
}

}  // namespace lcs::sim
