#include "tools/sequence/true_flow.h"

#include <algorithm>
#include <limits>
#include <vector>

namespace lcs::sequence {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
// As in sim/truth/truth.cpp: a point nearer than this share of its depth is in the camera plane.
constexpr double kInFront = 1e-6;
// Tolerated relative deviation of a visible point's depth from the rendered depths round it: the
// resolution of the depth buffer at far distances.
constexpr float kDepthSlack = 2e-3F;

/// Motion of one body's points from the camera at k to the camera at k+1.
struct Carrier {
  sim::Pose T_NC;
  bool moves = false;
};

/// \param row of frame k; `next_row` of frame k+1, which differs by point with a rolling shutter.
std::vector<Carrier> carriers_of(const sim::PointMotion& way, double row, double next_row) {
  std::vector<Carrier> carriers;
  for (std::size_t id = 0; id < way.moves().size(); ++id) {
    carriers.push_back({way.in_next(id, way.T_WC(row), row, next_row), way.moves(id)});
  }
  return carriers;
}

/// The rendered frame k+1.
struct NextView : Surfaces {
  bool holds(double x, double y) const {
    return x >= 0 && y >= 0 && x <= depth_m.cols - 1 && y <= depth_m.rows - 1;
  }
  /// Whether a surface at depth z is visible at a position: one of the four pixels round
  /// it shows that surface, and the depth lies between theirs.
  bool shows(double x, double y, float z, int surface) const {
    const int x0 = static_cast<int>(x), y0 = static_cast<int>(y);
    const auto is_within = [z](float least, float most) {
      return z >= least * (1 - kDepthSlack) && z <= most * (1 + kDepthSlack);
    };
    // Usually the upper left pixel suffices.
    if (const float here = depth_m(y0, x0); this->id(y0, x0) == surface && is_within(here, here)) {
      return true;
    }
    const int x1 = std::min(x0 + 1, depth_m.cols - 1), y1 = std::min(y0 + 1, depth_m.rows - 1);
    float nearest = std::numeric_limits<float>::infinity(), farthest = 0;
    bool is_there = false;
    for (const int row : {y0, y1}) {
      for (const int column : {x0, x1}) {
        const float depth = depth_m(row, column);
        nearest = std::min(nearest, depth);
        farthest = std::max(farthest, depth);
        is_there |= this->id(row, column) == surface;
      }
    }
    return is_there && is_within(nearest, farthest);
  }
};

}  // namespace

TrueFlow true_flow(const sim::Optics& camera, const sim::FrameTruth& truth,
                   const cv::Mat1i& surface_id, const Surfaces& next_surfaces) {
  const sim::PointMotion way(truth, truth.depth_m.rows);
  const bool rolls = !truth.now_rows.at.empty();
  const std::vector<Carrier> carriers = carriers_of(way, 0, 0);
  const NextView next{next_surfaces};
  const cv::Size size = truth.depth_m.size();
  TrueFlow field{cv::Mat2f(size), cv::Mat2f(size), cv::Mat1b(size), cv::Mat1b(size)};
  const double f = camera.lens().fu_px, cx = camera.lens().cu_px, cy = camera.lens().cv_px;

  // Along a row of a pinhole, a body's rotated ray changes by a constant step per pixel.
  std::vector<Eigen::Vector3d> row_start(carriers.size()), step(carriers.size());
  for (int y = 0; y < size.height; ++y) {
    for (std::size_t id = 0; id < carriers.size(); ++id) {
      const Eigen::Matrix3d& R = carriers[id].T_NC.R;
      row_start[id] = R * Eigen::Vector3d(-cx / f, (y - cy) / f, 1);
      step[id] = R.col(0) / f;
    }
    const sim::Pose T_WC = way.T_WC(y);
    const float* depth = truth.depth_m[y];
    const int* carrier = truth.carrier()[y];
    const int* surface = surface_id[y];
    cv::Vec2f* full = field.full_px[y];
    cv::Vec2f* ego = field.ego_px[y];
    unsigned char* seen = field.seen[y];
    unsigned char* ego_seen = field.ego_seen[y];
    for (int x = 0; x < size.width; ++x) {
      full[x] = ego[x] = {kNan, kNan};
      seen[x] = ego_seen[x] = 0;
      if (carrier[x] < 0) continue;
      const double w = 1 / static_cast<double>(depth[x]);
      const auto move = [&](std::size_t id, cv::Vec2f& motion, unsigned char& is_seen,
                            bool is_real) {
        const Eigen::Vector3d& t = carriers[id].T_NC.p;
        Eigen::Vector3d goal = row_start[id] + x * step[id] + w * t;
        if (!camera.is_pinhole()) {
          goal = carriers[id].T_NC.R * camera.ray(x, y).homogeneous() + w * t;
        }
        if (rolls) {
          const Eigen::Vector3d p_C = camera.back_project(Eigen::Vector2d(x, y), 1 / w);
          const Eigen::Vector3d p_W = T_WC * p_C;
          const double there = way.next_row(
              id, p_W, y, [&](const Eigen::Vector3d& p) { return camera.project(p).y(); });
          goal = w * way.in_next(id, p_W, y, there);
        }
        const double z = goal.z();
        if (z < kInFront) return;
        const double scale = f / z;
        double u = scale * goal.x() + cx, v = scale * goal.y() + cy;
        if (!camera.is_pinhole()) {
          const Eigen::Vector2d px = camera.project(goal);
          if (!px.allFinite()) return;
          u = px.x(), v = px.y();
        }
        motion = {static_cast<float>(u - x), static_cast<float>(v - y)};
        is_seen = next.holds(u, v) &&
                  (!is_real || next.shows(u, v, static_cast<float>(z / w), surface[x]));
      };
      const auto id = static_cast<std::size_t>(carrier[x]);
      move(0, ego[x], ego_seen[x], !carriers[id].moves);
      if (carriers[id].moves) {
        move(id, full[x], seen[x], true);
      } else {
        full[x] = ego[x];
        seen[x] = ego_seen[x];
      }
    }
  }
  return field;
}

}  // namespace lcs::sequence
