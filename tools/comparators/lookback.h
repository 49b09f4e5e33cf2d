/// \file
/// The earlier picture that a frame is compared with, and the camera's motion since. It is one of a
/// baseline ago, as motion between successive frames is too small at high frame rates.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

#include "filter/ego_motion/intake.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/kinematics/rotation.h"

namespace lcs::comparators {

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

}  // namespace lcs::comparators
