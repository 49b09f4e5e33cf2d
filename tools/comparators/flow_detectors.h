/// \file
/// The comparators, which track corners to a picture of a baseline ago (README.md).
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/video/tracking.hpp>
#include <optional>
#include <stdexcept>
#include <vector>

#include "filter/ego_motion/intake.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/kinematics/motion_field.h"
#include "filter/kinematics/rotation.h"
#include "sim/pictures/media.h"
#include "tools/bench/detector.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

// The earlier picture that a frame is compared with, and the camera's motion since. It is one of a
// baseline ago, as motion between successive frames is too small at high frame rates.

/// s: longer baselines lose the fast movers of the worlds of `train` (README.md); the last picture
/// alone would lose slow movers at high frame rates.
inline constexpr double kBaseline_s = 0.055;

/// The motion over two successive intervals.
inline EgoMotion composed(const EgoMotion& earlier, const EgoMotion& later) {
  EgoMotion motion;
  motion.dt_s = earlier.dt_s + later.dt_s;
  motion.R_cur_prev = later.R_cur_prev * earlier.R_cur_prev;
  if (motion.dt_s > 0) {
    const Eigen::Vector3d displacement_C_m =
        later.R_cur_prev * earlier.v_C_mps * earlier.dt_s + later.v_C_mps * later.dt_s;
    motion.v_C_mps = displacement_C_m / motion.dt_s;
    motion.w_C_radps = -logarithm(motion.R_cur_prev) / motion.dt_s;
  }
  motion.unseen_turn_rad = std::hypot(earlier.unseen_turn_rad, later.unseen_turn_rad);
  motion.velocity_sigma_mps = later.velocity_sigma_mps;
  motion.ground = later.ground;
  return motion;
}

/// The latest pictures, in the form used for comparison.
template <typename Picture>
class Lookback {
 public:
  /// \throws std::invalid_argument for a negative or NaN baseline.
  explicit Lookback(double baseline_s) : baseline_s_(baseline_s) {
    if (!(baseline_s >= 0)) throw std::invalid_argument("a baseline must be 0 s or more");
  }

  /// Call with each frame, in order. If the camera's motion since the last frame is unknown,
  /// earlier pictures are dropped.
  /// \return storage for this frame's picture; still holds an older one.
  Picture& begin(const EgoMotion& told) {
    const std::optional<EgoMotion> motion = intake_.take(told, diagnostics_);
    if (!motion) frames_.clear();
    for (Frame& frame : frames_) frame.since = composed(frame.since, *motion);
    // Reuses the oldest frame once another one is at least as old as the baseline.
    const std::size_t size = frames_.size();
    const bool full =
        size >= kMostFrames || (size >= 2 && frames_[size - 2].since.dt_s >= baseline_s_);
    if (!full) frames_.emplace_back();
    std::rotate(frames_.begin(), frames_.end() - 1, frames_.end());
    Frame& now = frames_.front();
    now.since = EgoMotion();
    if (motion) now.since.ground = motion->ground;

    compared_ = std::min<std::size_t>(1, frames_.size() - 1);
    const auto off_s = [&](std::size_t i) { return std::abs(frames_[i].since.dt_s - baseline_s_); };
    while (compared_ + 1 < frames_.size() && off_s(compared_ + 1) < off_s(compared_)) ++compared_;
    return now.picture;
  }

  /// The picture that the last `begin` returned.
  const Picture& now() const { return frames_.front().picture; }

  /// The earlier picture with an age nearest to the baseline; null in the first frame.
  const Picture* earlier() const { return compared_ > 0 ? &frames_[compared_].picture : nullptr; }

  /// The camera's motion since the earlier picture; zero in the first frame.
  const EgoMotion& motion() const { return frames_[compared_].since; }

  /// Counts of the faults in the given motions.
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  /// Bounds the memory.
  static constexpr std::size_t kMostFrames = 16;

  struct Frame {
    Picture picture;
    EgoMotion since;  ///< motion since this frame
  };

  double baseline_s_;
  Intake intake_;
  Diagnostics diagnostics_;
  std::vector<Frame> frames_;  ///< newest first
  std::size_t compared_ = 0;   ///< index of the frame to compare with; 0: none
};

// The epipolar segment: possible places of a static point in an earlier picture, from the nearest
// to the farthest depth. The farthest is infinity or, below the horizon with a known ground, the
// ground's depth on the corner's ray.

/// Largest distance of a static corner from the segment.
inline constexpr double kStatic_px = 0.85;

/// Motion field over an interval, with exact rotation and the filter's default bounds of depth:
/// z_min, and the ground with its slack.
MotionField exact_field(const Intrinsics& camera, const EgoMotion& motion);

/// px: distance of a corner's earlier place (rotation removed) from the epipolar segment.
double epipolar_distance(const MotionField& field, const Vec2& now_px, const Vec2& before_px);

struct KltParameters {
  double baseline_s = kBaseline_s;  ///< age of the image to compare with, about; >= 0
  int window_px = 15;               ///< side of the matched window; odd, >= 3
  int levels = 4;                   ///< pyramid levels above the image itself; >= 0
  int max_iterations = 30;          ///< on each level
  double least_step_px = 0.01;      ///< iterations end below this step
  double least_eigenvalue = 1e-4;   ///< of the window's gradients, normalised as in OpenCV
  double residual_px = kStatic_px;  ///< largest distance of a static corner from the segment
  GroupParameters groups = {};
};

/// The comparator `klt`, a baseline of common methods with OpenCV and an IMU. Each corner is
/// tracked back to the image of a baseline ago by pyramidal Lucas-Kanade (Bouguet, "Pyramidal
/// Implementation of the Affine Lucas Kanade Feature Detector", 2000; OpenCV's). A static point
/// lies on the epipolar segment there; other corners move by themselves.
///
/// A verdict belongs to a corner of the current frame, so the flow runs backwards from its corners
/// to the earlier image. Forward tracking would end at points that are no detected corners.
///
/// It gets the same camera motion and ground as the filter. It stores only images, and so decides
/// on two frames.
class KltDetector : public bench::Detector {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit KltDetector(const Intrinsics& camera, const KltParameters& parameters = {});
  const FrameResult& step(const bench::DetectorInput& input) override;
  Diagnostics diagnostics() const override { return pyramids_.diagnostics(); }

 private:
  Intrinsics camera_;
  KltParameters parameters_;
  const sim::OpticalFlow& flow_;
  Lookback<std::vector<cv::Mat>> pyramids_;
  RebelGroups groups_;
  std::vector<cv::Point2f> corners_, before_;  // scratch storage of the current frame
  std::vector<unsigned char> found_;
  std::vector<CornerMotion> motions_;
};

struct DisParameters {
  double baseline_s = kBaseline_s;  ///< age of the image to compare with, about; >= 0
  double residual_px = kStatic_px;  ///< largest distance of a static corner from the segment
  GroupParameters groups;
};

/// The comparator `dis`: dense flow (Kroeger et al., "Fast Optical Flow using Dense Inverse
/// Search", 2016; OpenCV's) from this image to one a baseline earlier, whose camera rotation is
/// removed first. A static corner's flow ends on the epipolar segment; other corners move by
/// themselves. Like `klt`, but a pixel's flow is smoothed with its neighbourhood.
class DisDetector : public bench::Detector {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit DisDetector(const Intrinsics& camera, const DisParameters& parameters = {});
  const FrameResult& step(const bench::DetectorInput& input) override;
  Diagnostics diagnostics() const override { return pictures_.diagnostics(); }

 private:
  Intrinsics camera_;
  DisParameters parameters_;
  Lookback<cv::Mat1b> pictures_;
  cv::Ptr<cv::DISOpticalFlow> flow_;
  RebelGroups groups_;
  cv::Mat1b derotated_;  // scratch storage of the current frame
  cv::Mat2f to_earlier_;
  std::vector<CornerMotion> motions_;
};

}  // namespace lcs::comparators
