#include "filter/path.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "filter/motion_field.h"

namespace lcs {
namespace {

/// px^2: far above what any path gives; a camera that flees at an absurd speed would take it to
/// infinity.
constexpr double kMostInformation = 1e50;

/// Share of what the path's length would tell if the point's place were known, below which what is
/// left is rounding.
constexpr double kRounding = 1e-9;

/// px^2 m^2: of what the sightings say of 1/Z, less than this is nothing.
constexpr double kLeastInformation = 1e-6;

/// Sightings closer together than this err alike, and count as one between them.
constexpr double kApart_s = 0.05;

/// \param share of a sighting that it counts.
void add_sighting(Eigen::Matrix4d& M, const Vec2& x_px, const Intrinsics& camera, double share) {
  const double f2 = share * camera.focal_px * camera.focal_px;
  const Vec2 n = (x_px - camera.centre_px) / camera.focal_px;
  M(0, 0) += f2;
  M(1, 1) += f2;
  M(2, 2) += f2 * n.squaredNorm();
  M.block<2, 1>(0, 2) -= f2 * n;
  M.block<1, 2>(2, 0) -= f2 * n.transpose();
}

}  // namespace

void Path::start(const Vec2& x_px, double depth_ratio, const Intrinsics& camera) {
  *this = Path{};
  anchor = x_px;
  ratio = depth_ratio;
  add_sighting(sightings, x_px, camera, 1);
}

void Path::carry(const MotionField& field) {
  anchor = field.rotated(anchor);
  travelled_C_m = field.R_cur_prev() * travelled_C_m + field.displacement_C_m();
  sightings = field.T_prev_cur().transpose() * sightings * field.T_prev_cur();
  if (!field.moving()) return;

  const double before = ratio;
  ratio = field.advanced_ratio(before);
  if (!(before > 0)) return;
  // h is in units of the depth of now, and so is the error that a former sighting is left with.
  const double shrink2 = (before / ratio) * (before / ratio);
  sightings *= shrink2;
  // The information shrinks besides as its unit, the ratio squared, grows.
  weight *= shrink2 * shrink2;
  if (!(sightings.trace() < kMostInformation && weight < kMostInformation)) {
    sightings.setZero();
    weight = 0;
  }
}

void Path::see(const Vec2& x_px, const Intrinsics& camera, const MotionField& field) {
  add_sighting(sightings, x_px, camera, std::min(1.0, field.dt_s() / kApart_s));
  // h' M h with h = (p, 1, w): what is left for w when the place p is at its best.
  const Eigen::Matrix4d& M = sightings;
  const Vec2 to_place = M.topLeftCorner<2, 2>().inverse() * M.block<2, 1>(0, 3);
  const double information = M(3, 3) - to_place.dot(M.block<2, 1>(0, 3));
  if (!(information > std::max(kLeastInformation, kRounding * M(3, 3)))) return;
  const double w = (to_place.dot(M.block<2, 1>(0, 2)) - M(3, 2)) / information;
  const double reference_m = field.reference_depth_m();
  ratio = std::clamp(w * reference_m, 0.0, field.max_ratio());
  weight = information / (reference_m * reference_m);
}

}  // namespace lcs
