/// \file
/// The LCS filter: a frame's corners and the ego-motion in, layers and a verdict for each corner
/// out.
#pragma once

#include <memory>
#include <span>
#include <string>
#include <vector>

#include "filter/diagnostics.h"
#include "filter/ego_motion/ego_motion.h"
#include "filter/kinematics/camera.h"
#include "filter/layers.h"
#include "filter/parameters.h"
#include "filter/reason.h"
#include "filter/signature.h"

namespace lcs {

/// Wall time of each expert in the last frame. For reports only: nothing in the filter reads it.
struct StageTimes {
  double line_ms = 0;
  double circle_ms = 0;
  double square_ms = 0;
};

/// What `Filter::step` has to say of a frame.
struct FrameResult {
  Layers layers;
  std::vector<Verdict> verdicts;  ///< one for each corner, in the caller's order
  std::vector<Reason> reasons;    ///< of each verdict; empty where a tracker gives none
  StageTimes times;
};

/// Deterministic: the same corners, signatures and motions give the same bits, in whatever order
/// the corners of a frame come.
///
/// Bad data never throw and leave no trace: corners that are none are left out; where the time or
/// the motion since the last frame is unknown, the filter starts anew, and from that frame on gives
/// what a new filter gives, but for the ids: rebels again at the third sighting, two frames later.
class Filter {
 public:
  /// \throws std::invalid_argument for parameters out of range, or a camera that is none.
  Filter(const Intrinsics& camera, const Parameters& parameters);
  ~Filter();
  Filter(Filter&&) noexcept;
  Filter& operator=(Filter&&) noexcept;

  /// \param corners_px of this frame (chi before the Line expert).
  /// \param motion since the last frame.
  /// \return the filter's own storage: valid until the next step.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px, const EgoMotion& motion);

  /// Likewise, and what each corner looks like.
  /// \param signatures one for each corner, in their order.
  /// \throws std::invalid_argument for fewer or more of them than corners; the frame then is as if
  ///   it had not been given.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& motion);

  /// What was wrong with the data of all frames so far.
  const Diagnostics& diagnostics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs
