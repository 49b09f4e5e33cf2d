/// \file
/// The picture that a frame is compared with, and how the camera moved since. At a high frame rate
/// nothing moves far enough from one frame to the next, so that it is not the last picture but one
/// of a baseline ago.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>
#include <stdexcept>
#include <vector>

#include "filter/ego_motion/intake.h"
#include "filter/kinematics/ego_motion.h"

namespace lcs::comparators {

/// Longer ones lose the fast movers of the worlds of `train` (README.md); with the last picture
/// alone, slow ones would be lost at high rates.
inline constexpr double kBaseline_s = 0.055;

/// The motion over two intervals, of which `later` begins where `earlier` ends.
EgoMotion composed(const EgoMotion& earlier, const EgoMotion& later);

/// The latest pictures, in whatever form they are compared.
template <typename Picture>
class Lookback {
 public:
  /// \throws std::invalid_argument for a baseline that is not a time.
  explicit Lookback(double baseline_s) : baseline_s_(baseline_s) {
    if (!(baseline_s >= 0)) throw std::invalid_argument("a baseline must be 0 s or more");
  }

  /// To be called with every frame, in order. Where the camera's motion since the last one is
  /// unknown, those before are forgotten.
  /// \return room for its picture, with what an older one left there.
  Picture& begin(const EgoMotion& told) {
    const std::optional<EgoMotion> motion = intake_.take(told, diagnostics_);
    if (!motion) frames_.clear();
    for (Frame& frame : frames_) frame.since = composed(frame.since, *motion);
    // The oldest makes room for the newest, once there is another one as old as the baseline.
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

  /// What `begin` gave room for last.
  const Picture& now() const { return frames_.front().picture; }

  /// The earlier picture whose age is nearest to the baseline; null in the first frame.
  const Picture* earlier() const { return compared_ > 0 ? &frames_[compared_].picture : nullptr; }

  /// The camera's motion since then; none in the first frame.
  const EgoMotion& motion() const { return frames_[compared_].since; }

  /// What was wrong with the motions that were told.
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  /// Bounds the memory.
  static constexpr std::size_t kMostFrames = 16;

  struct Frame {
    Picture picture;
    EgoMotion since;  ///< then
  };

  double baseline_s_;
  Intake intake_;
  Diagnostics diagnostics_;
  std::vector<Frame> frames_;  ///< the newest first
  std::size_t compared_ = 0;   ///< frame that the newest is compared with; itself: none
};

}  // namespace lcs::comparators
