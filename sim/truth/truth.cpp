#include "sim/truth/truth.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <iterator>
#include <limits>
#include <stdexcept>

namespace lcs::sim {
namespace {

constexpr double kDistinctPx = 1;  // least |u - u_s| of a rebel
// A body at rest on contacts creeps by nanometres. Smaller motions count as none.
constexpr double kStill_m = 1e-5;
constexpr double kStill_rad = 1e-5;
// Points of C with z below this fraction of their depth count as in the camera's plane.
constexpr double kInFront = 1e-6;

/// The surface that a corner lies on.
struct Surface {
  int object = -1, carrier = -1;
  float depth_m = std::numeric_limits<float>::infinity();
};

/// Calls `visit(pixel, squared distance in px^2)` for the image's pixels within `radius_px` columns
/// and rows of the corner's pixel.
template <typename Visit>
void visit_about(const Eigen::Vector2f& corner, int radius_px, cv::Size image_px, Visit&& visit) {
  // farther or NaN corners could overflow an int
  const double reach_px = radius_px + 1;
  if (!((corner.cast<double>().array() >= -reach_px).all() &&
        corner.x() <= image_px.width + reach_px && corner.y() <= image_px.height + reach_px)) {
    return;
  }
  const int cx = static_cast<int>(std::lround(corner.x()));
  const int cy = static_cast<int>(std::lround(corner.y()));
  for (int y = std::max(0, cy - radius_px); y <= std::min(image_px.height - 1, cy + radius_px); ++y)
    for (int x = std::max(0, cx - radius_px); x <= std::min(image_px.width - 1, cx + radius_px);
         ++x)
      visit(cv::Point(x, y), (x - cx) * (x - cx) + (y - cy) * (y - cy));
}

Surface nearest_3x3(const FrameTruth& truth, const Eigen::Vector2f& corner) {
  Surface nearest;
  visit_about(corner, 1, truth.depth_m.size(), [&](const cv::Point& pixel, int) {
    const float depth = truth.depth_m(pixel);
    if (depth < nearest.depth_m) nearest = {truth.object(pixel), truth.carrier()(pixel), depth};
  });
  return nearest;
}

/// Whether a moving body is visible within FAST's circle of 16 pixels around a corner.
bool is_beside_mover(const FrameTruth& truth, const std::vector<char>& moves,
                     const Eigen::Vector2f& corner) {
  constexpr int kCircle_px2 = 3 * 3 + 1;  // its pixels are at (3, 0), (3, 1), (2, 2) and so on
  bool found = false;
  visit_about(corner, 3, truth.object.size(), [&](const cv::Point& pixel, int distance2) {
    const int object = truth.object(pixel);
    found |= distance2 <= kCircle_px2 && object >= 0 && moves[static_cast<std::size_t>(object)];
  });
  return found;
}

bool is_at_shadow_edge(const FrameTruth& truth, const Eigen::Vector2f& corner) {
  bool found = false;
  visit_about(corner, 0, truth.shadow_edge.size(),
              [&](const cv::Point& pixel, int) { found = truth.shadow_edge(pixel) != 0; });
  return found;
}

/// Images at k+1 of one corner as a fixed point, over its inverse depth w: the pixel of h + w t.
struct StaticSegment {
  Eigen::Vector3d h;  ///< the corner's ray in C of k+1, z-depth 1: the ideal point
  Eigen::Vector3d t;  ///< the old camera centre in C of k+1

  Eigen::Vector3d at(double w) const { return h + w * t; }
};

double distance_to_segment(const Eigen::Vector2d& p, const Eigen::Vector2d& a,
                           const Eigen::Vector2d& b) {
  const Eigen::Vector2d ab = b - a;
  const double length2 = ab.squaredNorm();
  const double share = length2 > 0 ? std::clamp((p - a).dot(ab) / length2, 0.0, 1.0) : 0.0;
  return (p - a - share * ab).norm();
}

/// Distance of a pixel at k+1 from a segment; +inf if the whole segment is behind the camera.
double distance_to(const Pinhole& camera, const StaticSegment& segment, double max_w,
                   const Eigen::Vector2d& p) {
  // the part in front of the camera is one interval: z(w) = h.z + w t.z is linear
  double first = 0;
  double last = max_w;
  const auto z = [&](double w) { return segment.at(w).z(); };
  if (z(first) < kInFront && z(last) < kInFront) return std::numeric_limits<double>::infinity();
  const double crossing = (kInFront - segment.h.z()) / segment.t.z();
  if (z(first) < kInFront) first = crossing;
  if (z(last) < kInFront) last = crossing;
  return distance_to_segment(p, camera.project(segment.at(first)),
                             camera.project(segment.at(last)));
}

Pose between(const Pose& a, const Pose& b, double share) {
  if (share == 0) return a;
  const Eigen::Quaterniond from(a.R), to(b.R);
  return {from.slerp(share, to).toRotationMatrix(), (1 - share) * a.p + share * b.p};
}

CornerTruth label(const Pinhole& camera, const FrameTruth& truth, const PointMotion& way,
                  const Eigen::Vector2f& corner, double min_depth_m, const Optics* picture) {
  CornerTruth result;
  const bool is_bent = picture && !picture->is_pinhole();
  const Eigen::Vector2f place =
      is_bent ? picture->project(camera.back_project(corner.cast<double>(), 1)).cast<float>()
              : corner;
  const Surface surface = nearest_3x3(truth, place);
  if (surface.object < 0 || is_at_shadow_edge(truth, place)) return result;
  result.object = surface.object;
  result.depth_m = surface.depth_m;

  const Eigen::Vector2d x = corner.cast<double>();
  const Eigen::Vector3d p_C = camera.back_project(x, result.depth_m);
  const std::size_t id = static_cast<std::size_t>(surface.carrier);
  const double row = place.y();
  const auto row_of = [&](const Eigen::Vector3d& p_N) {
    return is_bent ? picture->project(p_N).y() : camera.project(p_N).y();
  };
  const Pose T_WC = way.T_WC(row);
  const Eigen::Vector3d p_W = T_WC * p_C;
  const double fixed_row = way.next_row(0, p_W, row, row_of);
  const Eigen::Vector3d fixed_N = way.in_next(0, p_W, row, fixed_row);
  const Eigen::Vector3d carried_N =
      way.moves(id) ? way.in_next(id, p_W, row, way.next_row(id, p_W, row, row_of)) : fixed_N;

  const auto motion = [&](const Eigen::Vector3d& p_N) -> Eigen::Vector2d {
    if (p_N.z() < kInFront * result.depth_m) {
      return Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());
    }
    return camera.project(p_N) - x;
  };
  result.static_motion_px = motion(fixed_N);
  result.motion_px = motion(carried_N);

  if (!way.any_moves(static_cast<std::size_t>(surface.object))) {
    result.label = Label::fixed;
    result.outline = is_beside_mover(truth, way.any_moves(), place);
  } else if ((result.motion_px - result.static_motion_px).norm() >= kDistinctPx) {
    result.label = Label::rebel;
    const Pose T_NC = way.in_next(0, T_WC, row, fixed_row);
    const StaticSegment segment{T_NC.R * camera.back_project(x, 1), T_NC.p};
    const double distance = distance_to(camera, segment, 1 / min_depth_m, x + result.motion_px);
    result.radial = distance <= kDistinctPx;
  } else {
    result.label = Label::indistinct;
  }
  return result;
}

}  // namespace

bool moved(const Pose& now, const Pose& next) {
  // |R - R'| (Frobenius) is sqrt(2) times the angle between them, if it is small
  return (next.p - now.p).norm() > kStill_m ||
         (next.R - now.R).norm() > std::sqrt(2.0) * kStill_rad;
}

PointMotion::PointMotion(const FrameTruth& truth, int height_px) : rolls_(!truth.now_rows.at.empty()) {
  const auto at_rows = [&](const Readout& readout, const Pose& now, auto pose_of) -> Poses {
    if (readout.at.empty()) return {now};
    Poses steps, poses;
    std::ranges::transform(readout.at, std::back_inserter(steps), pose_of);
    for (int row = 0; row <= height_px; ++row) {
      poses.push_back(pose_at(steps, (row - readout.first_row) / readout.rows_per_step));
    }
    return poses;
  };
  T_WC_ = at_rows(truth.now_rows, truth.now.T_WC, &Snapshot::T_WC);
  next_T_WC_ = at_rows(truth.next_rows, truth.next.T_WC, &Snapshot::T_WC);
  for (std::size_t id = 0; id < truth.now.T_WO.size(); ++id) {
    moves_.push_back(moved(truth.now.T_WO[id], truth.next.T_WO.at(id)));
    const auto object = [&](const Snapshot& s) -> const Pose& { return s.T_WO[id]; };
    const Readout still;
    T_WO_.push_back(at_rows(moves(id) ? truth.now_rows : still, truth.now.T_WO[id], object));
    next_T_WO_.push_back(at_rows(moves(id) ? truth.next_rows : still, truth.next.T_WO[id], object));
  }
  any_moves_ = moves_;
  const std::size_t objects = moves_.size() - truth.limb_objects.size();
  for (std::size_t i = 0; i < truth.limb_objects.size(); ++i) {
    any_moves_.at(static_cast<std::size_t>(truth.limb_objects[i])) |= moves_[objects + i];
  }
}

Pose PointMotion::pose_at(const Poses& poses, double row) {
  if (poses.size() == 1) return poses.front();
  const double last = static_cast<double>(poses.size() - 1);
  const double within = row >= 0 ? std::min(row, last) : 0;  // 0 for NaN
  const double before = std::min(std::floor(within), last - 1);
  return between(poses[static_cast<std::size_t>(before)],
                 poses[static_cast<std::size_t>(before) + 1], within - before);
}

std::vector<CornerTruth> label_corners(const Pinhole& camera, const FrameTruth& truth,
                                       std::span<const Eigen::Vector2f> corners_px,
                                       double min_depth_m, const Optics* picture) {
  if (!(min_depth_m > 0))
    throw std::invalid_argument("the nearest depth of truth must be positive");
  const PointMotion way(truth, truth.depth_m.rows);
  std::vector<CornerTruth> labels;
  labels.reserve(corners_px.size());
  for (const Eigen::Vector2f& corner : corners_px) {
    labels.push_back(label(camera, truth, way, corner, min_depth_m, picture));
  }
  return labels;
}

std::vector<ObjectTruth> modal_boxes(const cv::Mat1i& object, int count) {
  std::vector<ObjectTruth> boxes(static_cast<std::size_t>(count));
  for (int id = 1; id <= count; ++id) {
    boxes[static_cast<std::size_t>(id - 1)] = {
        .object = id, .left = object.cols, .top = object.rows, .mask = {}};
  }
  for (int y = 0; y < object.rows; ++y) {
    const int* row = object[y];
    for (int x = 0; x < object.cols; ++x) {
      if (row[x] <= 0) continue;
      ObjectTruth& box = boxes.at(static_cast<std::size_t>(row[x] - 1));
      box.left = std::min(box.left, x);
      box.top = std::min(box.top, y);
      box.right = std::max(box.right, x + 1);
      box.bottom = std::max(box.bottom, y + 1);
      ++box.visible_px;
    }
  }
  cv::Mat1i columns;
  cv::transpose(object, columns);
  for (ObjectTruth& box : boxes) {
    if (box.visible_px > 0) box.mask = runs_of(columns, mask_of(box).box, box.object);
  }
  return boxes;
}

}  // namespace lcs::sim
