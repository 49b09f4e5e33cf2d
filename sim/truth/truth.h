/// \file
/// The true state of a frame, and of its corners and objects. `tools/scoring/SCORING.md` defines
/// the figures that are computed from it.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "sim/base/optics.h"
#include "sim/base/pose.h"
#include "sim/truth/mask.h"

namespace lcs::sim {

/// A named body of the scene, or an actor: an object that a square should find. Ids are 1..n, in a
/// fixed order.
struct Object {
  int id = 0;
  std::string name;
};

/// Poses at one time. `T_WO[id]` is the pose of object `id`; index 0 is the fixed world (identity).
/// The poses of the objects' limbs follow, see `FrameTruth::carrier`.
struct Snapshot {
  Pose T_WC;
  std::vector<Pose> T_WO;
};

/// The poses at the times of a frame's rows, for a rolling shutter.
struct Readout {
  std::vector<Snapshot> at;  ///< at equal steps; empty: all rows show one time
  double first_row = 0;      ///< of the first of them
  double rows_per_step = 0;
};

/// The truth of frame k. Depth and object ids come from a render without multisampling.
struct FrameTruth {
  /// z-depth in metres; +inf for the sky.
  cv::Mat1f depth_m;
  /// Per pixel: id of an object, 0 for the fixed setting (floor, walls), -1 for pixels without a
  /// landmark (sky, the rover itself).
  cv::Mat1i object;
  /// \name Limbs: rigid parts of objects, each with a motion of its own. Without limbs both are
  /// empty.
  ///@{
  cv::Mat1i part;                 ///< as `carrier()`
  std::vector<int> limb_objects;  ///< ids of the objects whose limbs have the last poses of `T_WO`
  ///@}
  /// Per pixel: 1 within `kShadowEdge_px` of the edge of a shadow, which moves as neither the
  /// surface that it lies on nor the body that casts it; empty without shadows.
  cv::Mat1i shadow_edge;
  Snapshot now;                                         ///< at frame k
  Snapshot next;                                        ///< at frame k+1, also for the last frame
  Readout now_rows, next_rows;                          ///< of a rolling shutter
  Eigen::Vector3d v_WC_mps = Eigen::Vector3d::Zero();   ///< velocity of the camera, in W
  Eigen::Vector3d w_C_radps = Eigen::Vector3d::Zero();  ///< body rate of the camera, in C

  /// Per pixel: index in `T_WO` of the rigid body that carries the pixel's surface; as `object`,
  /// but for limbs.
  const cv::Mat1i& carrier() const { return part.empty() ? object : part; }
};

/// The way of points from the rows of frame k to the rows of frame k+1, whose times differ with a
/// rolling shutter. Between the poses of a `Readout` positions and rotations are interpolated.
class PointMotion {
 public:
  /// \param height_px of the picture.
  PointMotion(const FrameTruth& truth, int height_px);

  /// Whether a body moves from k to k+1. `object` here and below may be a limb's index in `T_WO`.
  bool moves(std::size_t object) const { return moves_.at(object) != 0; }
  /// Whether an object or any of its limbs moves.
  bool any_moves(std::size_t object) const { return any_moves_.at(object) != 0; }
  const std::vector<char>& any_moves() const { return any_moves_; }
  const std::vector<char>& moves() const { return moves_; }
  /// \name Poses at the time of a row of frame k.
  ///@{
  Pose T_WC(double row) const { return pose_at(T_WC_, row); }
  Pose T_WO(std::size_t object, double row) const { return pose_at(T_WO_.at(object), row); }
  ///@}
  /// In C of frame k+1, at the time of its row `next_row`, a point that was seen in `row`, or a
  /// frame of points. \param in_W at the time of `row`. \param object that carries it; 0: it is
  /// fixed in W.
  template <class PointOrPose>
  PointOrPose in_next(std::size_t object, const PointOrPose& in_W, double row,
                      double next_row) const {
    const Pose T_NW = pose_at(next_T_WC_, next_row).inverse();
    if (!moves(object)) return T_NW * in_W;
    return T_NW * (pose_at(next_T_WO_[object], next_row) * (T_WO(object, row).inverse() * in_W));
  }
  /// The row in which frame k+1 shows a point of W that was seen in `row`: the one at whose time
  /// the point is seen there. \param row_of gives the row of a point in C.
  template <class RowOf>
  double next_row(std::size_t object, const Eigen::Vector3d& p_W, double row,
                  RowOf&& row_of) const {
    double there = row;
    for (int i = 0; i < (rolls_ ? kMostSteps : 0); ++i) {
      const double seen = row_of(in_next(object, p_W, row, there));
      if (!(std::abs(seen - there) > kExact_px)) break;  // or there is none
      there = seen;
    }
    return there;
  }

 private:
  static constexpr int kMostSteps = 20;
  static constexpr double kExact_px = 1e-7;
  using Poses = std::vector<Pose>;  ///< at the times of rows 0, 1, ... h; one: at all times
  static Pose pose_at(const Poses& poses, double row);

  bool rolls_;
  std::vector<char> moves_, any_moves_;
  Poses T_WC_, next_T_WC_;
  std::vector<Poses> T_WO_, next_T_WO_;  ///< by object
};

enum class Label {
  /// On the sky, the rover or the edge of a shadow: no landmark, excluded from every count.
  none,
  fixed,  ///< its object does not move between k and k+1 ("static"), nor does a limb of it
  /// Its object moves, but |u - u_s| < 1 px.
  indistinct,
  rebel,  ///< its object moves, and |u - u_s| >= 1 px
};

/// Corners this near to the edge of a shadow have label `none`: FAST's circle may contain it.
inline constexpr int kShadowEdge_px = 3;

/// Whether a body moves between k and k+1: by more than 0.01 mm or 0.01 mrad. That is far below
/// what an image resolves and far above the creep of a body that rests on contacts.
bool moved(const Pose& now, const Pose& next);

/// The truth of one corner. Motions are from k to k+1, and NaN for a point behind the camera at
/// k+1; a corner on a moving body is then `indistinct`.
struct CornerTruth {
  Label label = Label::none;
  /// A rebel whose u lies within 1 px of the static segment: the images at k+1 of the same corner
  /// as a fixed point at every depth from `min_depth_m` to infinity. Two frames cannot distinguish
  /// it from a static point.
  bool radial = false;
  /// A fixed corner whose FAST circle (radius 3 px) contains a moving body. FAST then detects the
  /// crossing of the body's outline with the background, which moves with the outline.
  bool outline = false;
  int object = -1;     ///< as in FrameTruth::object
  double depth_m = 0;  ///< of the nearest surface in the 3x3 pixels around the corner
  Eigen::Vector2d motion_px = Eigen::Vector2d::Zero();         ///< u: its motion, k to k+1
  Eigen::Vector2d static_motion_px = Eigen::Vector2d::Zero();  ///< u_s: the same if fixed in W
};

/// \param camera in whose pixels corners and motions are, and the limits of 1 px.
/// \param corners_px in frame k; a corner outside the image has label `none`.
/// \param min_depth_m least depth of the static segment (z_min), > 0.
/// \param picture of depth and objects, if that is not by `camera`.
std::vector<CornerTruth> label_corners(const Pinhole& camera, const FrameTruth& truth,
                                       std::span<const Eigen::Vector2f> corners_px,
                                       double min_depth_m, const Optics* picture = nullptr);

/// An object's modal (visible) box and mask, and its visible share.
struct ObjectTruth {
  int object = 0;
  /// Pixel edges: [left, right) x [top, bottom); the area is (right-left) * (bottom-top).
  int left = 0, top = 0, right = 0, bottom = 0;
  int visible_px = 0;  ///< pixels of the mask
  /// Visible share of the full silhouette, which extends beyond the image; 0 if the body reaches
  /// behind the camera, where its silhouette is unbounded. Areas are measured in a pinhole's image.
  double visible_fraction = 0;
  bool moving = false;  ///< its pose, or the pose of a limb, differs between k and k+1
  PixelRuns mask;       ///< its pixels within the box; empty if unknown
};

/// The mask of an object's visible pixels; its runs are empty if unknown.
inline Mask mask_of(const ObjectTruth& truth) {
  return {cv::Rect(cv::Point(truth.left, truth.top), cv::Point(truth.right, truth.bottom)),
          truth.mask};
}

/// Boxes, masks and pixel counts of objects 1..count in an image of ids. Other members are not set.
std::vector<ObjectTruth> modal_boxes(const cv::Mat1i& object, int count);

}  // namespace lcs::sim
