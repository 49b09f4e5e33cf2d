#include "sim/scene/silhouette.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <opencv2/imgproc.hpp>

#include "sim/scene/model.h"

namespace lcs::sim {
namespace {

// Larger silhouettes are measured on a coarser raster.
constexpr double kMostRasterPixels = 4e6;

constexpr int kRound = 48;  // points per circle: error 0.2 % of the radius
constexpr int kRings = 16;  // from pole to pole of an ellipsoid

Eigen::Matrix3Xd box(const double size[3]) {
  Eigen::Matrix3Xd points(3, 8);
  for (int i = 0; i < 8; ++i) {
    points.col(i) << (i & 1 ? size[0] : -size[0]), (i & 2 ? size[1] : -size[1]),
        (i & 4 ? size[2] : -size[2]);
  }
  return points;
}

/// Two rings of radius r at z = +-h.
Eigen::Matrix3Xd cylinder(double r, double h) {
  Eigen::Matrix3Xd points(3, 2 * kRound);
  for (int i = 0; i < kRound; ++i) {
    const double a = 2 * std::numbers::pi * i / kRound;
    points.col(2 * i) << r * std::cos(a), r * std::sin(a), h;
    points.col(2 * i + 1) << r * std::cos(a), r * std::sin(a), -h;
  }
  return points;
}

/// An ellipsoid whose halves are moved apart by h along z (a capsule; 0: an ellipsoid).
Eigen::Matrix3Xd ellipsoid(const Eigen::Vector3d& radii, double h) {
  Eigen::Matrix3Xd points(3, (kRings + 2) * kRound);
  int n = 0;
  for (int half = -1; half <= 1; half += 2) {
    constexpr int kHalf = kRings / 2;
    for (int ring = 0; ring <= kHalf; ++ring) {
      const double latitude = half * std::numbers::pi / 2 * ring / kHalf;
      for (int i = 0; i < kRound; ++i) {
        const double a = 2 * std::numbers::pi * i / kRound;
        points.col(n++) << radii.x() * std::cos(latitude) * std::cos(a),
            radii.y() * std::cos(latitude) * std::sin(a), radii.z() * std::sin(latitude) + half * h;
      }
    }
  }
  return points;
}

Eigen::Matrix3Xd mesh(const mjModel& m, int mesh) {
  const int first = m.mesh_vertadr[mesh];
  const int count = m.mesh_vertnum[mesh];
  return Eigen::Map<const Eigen::Matrix3Xf>(m.mesh_vert + 3 * std::size_t(first), 3, count)
      .cast<double>();
}

using Polygon = std::vector<cv::Point2f>;

/// Calls `span(y, first, last)` for each row of pixels whose centres a convex polygon covers.
void rasterise(const Polygon& polygon, const auto& span) {
  float top = std::numeric_limits<float>::max();
  float bottom = std::numeric_limits<float>::lowest();
  for (const auto& p : polygon) {
    top = std::min(top, p.y);
    bottom = std::max(bottom, p.y);
  }
  for (int y = static_cast<int>(std::ceil(top)); static_cast<float>(y) <= bottom; ++y) {
    const auto row = static_cast<float>(y);
    float left = std::numeric_limits<float>::max();
    float right = std::numeric_limits<float>::lowest();
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      const cv::Point2f& a = polygon[i];
      const cv::Point2f& b = polygon[(i + 1) % polygon.size()];
      if ((a.y < row && b.y < row) || (a.y > row && b.y > row)) continue;
      const float share = a.y == b.y ? 0 : (row - a.y) / (b.y - a.y);
      left = std::min({left, a.x + share * (b.x - a.x), a.y == b.y ? b.x : left});
      right = std::max({right, a.x + share * (b.x - a.x), a.y == b.y ? b.x : right});
    }
    const int first = static_cast<int>(std::ceil(left));
    const int last = static_cast<int>(std::floor(right));
    if (first <= last) span(y, first, last);
  }
}

}  // namespace

Eigen::Matrix3Xd geom_hull(const mjModel& m, int geom) {
  const double* size = m.geom_size + 3 * geom;
  const int type = m.geom_type[geom];
  if (type == mjGEOM_BOX) return box(size);
  if (type == mjGEOM_SPHERE) return ellipsoid(Eigen::Vector3d::Constant(size[0]), 0);
  if (type == mjGEOM_ELLIPSOID) return ellipsoid({size[0], size[1], size[2]}, 0);
  if (type == mjGEOM_CAPSULE) return ellipsoid(Eigen::Vector3d::Constant(size[0]), size[1]);
  if (type == mjGEOM_CYLINDER) return cylinder(size[0], size[1]);
  if (type == mjGEOM_MESH) return mesh(m, m.geom_dataid[geom]);
  throw MujocoError("planes and height fields belong to the setting, not to a body");
}

double silhouette_px(const Pinhole& camera, const Pose& T_CO, const ConvexParts& parts,
                     double near_m) {
  std::vector<Polygon> outlines;
  outlines.reserve(parts.size());
  Polygon projected;
  cv::Point2f low(std::numeric_limits<float>::max(), std::numeric_limits<float>::max());
  cv::Point2f high = -low;
  for (const Eigen::Matrix3Xd& part : parts) {
    projected.clear();
    for (Eigen::Index i = 0; i < part.cols(); ++i) {
      const Eigen::Vector3d x_C = T_CO * part.col(i);
      if (x_C.z() < near_m) return 0;
      const Eigen::Vector2f px = camera.project(x_C).cast<float>();
      projected.emplace_back(px.x(), px.y());
      low = {std::min(low.x, px.x()), std::min(low.y, px.y())};
      high = {std::max(high.x, px.x()), std::max(high.y, px.y())};
    }
    cv::convexHull(projected, outlines.emplace_back());
  }
  if (outlines.empty()) return 0;

  const double area = double(high.x - low.x + 1) * double(high.y - low.y + 1);
  const float scale =
      area > kMostRasterPixels ? static_cast<float>(std::sqrt(kMostRasterPixels / area)) : 1.F;
  // whole pixels, to keep the image's pixel grid
  const cv::Point2f origin(std::floor(low.x), std::floor(low.y));
  cv::Mat1b covered(static_cast<int>((high.y - origin.y) * scale) + 2,
                    static_cast<int>((high.x - origin.x) * scale) + 2, uchar{0});
  for (Polygon& outline : outlines) {
    for (cv::Point2f& p : outline) p = (p - origin) * scale;
    rasterise(outline, [&](int y, int first, int last) {
      std::fill(covered[y] + first, covered[y] + last + 1, uchar{1});
    });
  }
  return cv::countNonZero(covered) / (double(scale) * scale);
}

}  // namespace lcs::sim
