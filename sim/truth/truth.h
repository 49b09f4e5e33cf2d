/// \file
/// The true state of a frame, and of its corners and objects. `tools/scoring/SCORING.md` defines
/// the figures that are computed from it.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "sim/camera/optics.h"
#include "sim/pose.h"
#include "sim/truth/mask.h"

namespace lcs::sim {

/// A named body of the scene, or an actor: an object that a square should find. Ids are 1..n, in a
/// fixed order.
struct Object {
  int id = 0;
  std::string name;
};

/// Poses at one time. `T_WO[id]` is the pose of object `id`; index 0 is the fixed world (identity).
struct Snapshot {
  Pose T_WC;
  std::vector<Pose> T_WO;
};

/// The truth of frame k. Depth and object ids come from a render without multisampling.
struct FrameTruth {
  /// z-depth in metres; +inf for the sky.
  cv::Mat1f depth_m;
  /// Per pixel: id of an object, 0 for the fixed setting (floor, walls), -1 for pixels without a
  /// landmark (sky, the rover itself).
  cv::Mat1i object;
  Snapshot now;                                         ///< at frame k
  Snapshot next;                                        ///< at frame k+1, also for the last frame
  Eigen::Vector3d v_WC_mps = Eigen::Vector3d::Zero();   ///< velocity of the camera, in W
  Eigen::Vector3d w_C_radps = Eigen::Vector3d::Zero();  ///< body rate of the camera, in C
};

enum class Label {
  none,   ///< on the sky or the rover: no landmark, excluded from every count
  fixed,  ///< its body does not move between k and k+1 ("static")
  /// Its body moves, but |u - u_s| < 1 px.
  indistinct,
  rebel,  ///< its body moves, and |u - u_s| >= 1 px
};

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
  /// behind the camera, where its silhouette is unbounded. Areas are those in a pinhole's image.
  double visible_fraction = 0;
  bool moving = false;  ///< its pose at k+1 differs from that at k
  Runs mask;            ///< its pixels within the box; empty if unknown
};

/// The mask of an object's visible pixels; its runs are empty if unknown.
inline Mask mask_of(const ObjectTruth& truth) {
  return {cv::Rect(cv::Point(truth.left, truth.top), cv::Point(truth.right, truth.bottom)),
          truth.mask};
}

/// Boxes, masks and pixel counts of objects 1..count in an image of ids. Other members are not set.
std::vector<ObjectTruth> modal_boxes(const cv::Mat1i& object, int count);

}  // namespace lcs::sim
