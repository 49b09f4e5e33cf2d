/// \file
/// The LCS filter: takes the corners of a frame and the ego-motion, gives layers and a verdict for
/// each corner.
#pragma once

#include <memory>
#include <span>
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

/// What `Filter::step` finds in one frame.
struct FrameResult {
  Layers layers;
  std::vector<Verdict> verdicts;  ///< one for each corner, in the caller's order
  std::vector<Reason> reasons;    ///< of each verdict; empty where a tracker gives none
  StageTimes times;
};

/// Deterministic: the same corners, signatures and motions give the same bits, in whatever order
/// the corners of a frame come.
///
/// Bad data never throw and have no lasting effect. Invalid corners are dropped. Where the time or
/// the motion since the last frame is unknown, the filter starts anew: from that frame on it gives
/// what a new filter gives, but for the ids, so that rebels come again one or two frames later.
class Filter {
 public:
  /// \throws std::invalid_argument for parameters out of range, or an invalid camera.
  Filter(const Intrinsics& camera, const Parameters& parameters);
  ~Filter();
  Filter(Filter&&) noexcept;
  Filter& operator=(Filter&&) noexcept;

  /// \param corners_px of this frame (chi before the Line expert).
  /// \param motion since the last frame.
  /// \return the filter's own storage: valid until the next step.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px, const EgoMotion& motion);

  /// The same, with what each corner looks like.
  /// \param signatures one for each corner, in their order.
  /// \throws std::invalid_argument for fewer or more of them than corners; the filter then stays as
  ///   it was before the call.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& motion);

  /// What was wrong with the data of all frames so far.
  const Diagnostics& diagnostics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs
