// A value for each pixel: optical flow and depth.
#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <limits>
#include <vector>

#include "tools/sequence/png.h"
#include "tools/sequence/true_flow.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

constexpr float kKittiDepthScale = 256;  // codes per metre

/// Middlebury's code for unknown flow: any value beyond 1e9.
constexpr float kMiddleburyUnknown = 1e10F;

/// The motion of each pixel in KITTI's encoding.
cv::Mat3w kitti_flow(const cv::Mat2f& motion_px, const cv::Mat1b& valid) {
  cv::Mat3w code(motion_px.size());
  std::transform(motion_px.begin(), motion_px.end(), valid.begin(), code.begin(), kitti_code);
  return code;
}

/// \return the bytes of a .flo file.
std::string middlebury_flow(const cv::Mat2f& motion_px) {
  static_assert(std::endian::native == std::endian::little, "the format is little-endian");
  constexpr float kTag = 202021.25F;
  const std::int32_t size[2] = {motion_px.cols, motion_px.rows};
  cv::Mat2f known = motion_px.clone();
  cv::patchNaNs(known, kMiddleburyUnknown);
  std::string bytes;
  bytes.reserve(sizeof kTag + sizeof size + known.total() * known.elemSize());
  bytes.append(reinterpret_cast<const char*>(&kTag), sizeof kTag);
  bytes.append(reinterpret_cast<const char*>(size), sizeof size);
  bytes.append(reinterpret_cast<const char*>(known.data), known.total() * known.elemSize());
  return bytes;
}

/// Rounds to the nearest 1/256 m; 0 means no depth: the sky, and anything beyond 255.99 m.
cv::Mat1w kitti_depth(const cv::Mat1f& depth_m) {
  cv::Mat1w code(depth_m.size());
  std::transform(depth_m.begin(), depth_m.end(), code.begin(), [](float metres) {
    const float scaled = metres * kKittiDepthScale + 0.5F;
    return scaled < 65536 ? static_cast<std::uint16_t>(scaled) : std::uint16_t{0};
  });
  return code;
}

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

/// Optical flow in KITTI's 16-bit PNG and Middlebury's .flo: the full motion, and the camera's part
/// of it.
Writer flow_writer(const SequenceInfo&) {
  return {[](const FrameView& frame, FrameOutput& output) {
    if (frame.motion == nullptr) return;  // the last frame has no successor
    const int k = frame.now.index;
    const auto add = [&](const char* kind, const cv::Mat2f& motion, const cv::Mat1b& seen) {
      output.files.push_back({fmt::format("{}/kitti/{:06}.png", kind, k),
                              encode_png(kitti_flow(motion, seen), PngFilter::sub), ""});
      output.files.push_back(
          {fmt::format("{}/middlebury/{:06}.flo", kind, k), middlebury_flow(motion), ""});
    };
    add("flow", frame.motion->full_px, frame.motion->seen);
    add("flow_ego", frame.motion->ego_px, frame.motion->ego_seen);
  }};
}

/// Depth along the optical axis in KITTI's format: 16-bit PNG, 256 codes per metre.
Writer depth_writer(const SequenceInfo&) {
  return {[](const FrameView& frame, FrameOutput& output) {
    output.files.push_back({fmt::format("depth/{:06}.png", frame.now.index),
                            encode_png(kitti_depth(frame.now.truth.depth_m), PngFilter::sub), ""});
  }};
}

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
