/// \file
/// The LCS filter: takes the corners of a frame and the ego-motion, gives layers and a verdict for
/// each corner. filter/MODEL.md is its specification; `filter/paper/` has the paper's own filter.
#pragma once

#include <memory>
#include <span>

#include "filter/diagnostics.h"
#include "filter/frame_result.h"
#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/parameters.h"
#include "filter/signature.h"

namespace lcs {

/// Deterministic: the same corners, signatures and motions give the same bits, in whatever order
/// the corners of a frame come.
///
/// Bad data never throw and have no lasting effect. Invalid corners are dropped. Where the time or
/// the motion since the last frame is unknown, the filter starts anew: from that frame on its
/// results equal those of a new filter, except for the ids.
class Filter {
 public:
  /// \throws std::invalid_argument for parameters out of range, or an invalid camera.
  explicit Filter(const Intrinsics& camera, const Parameters& parameters = {});
  ~Filter();
  Filter(Filter&&) noexcept;
  Filter& operator=(Filter&&) noexcept;

  /// \param corners_px of this frame, pixels.
  /// \param motion since the last frame.
  /// \return the filter's own storage: valid until the next step.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px, const EgoMotion& motion);

  /// \param signatures one for each corner, in their order.
  /// \throws std::invalid_argument for fewer or more signatures than corners; the filter is then as
  ///   it was before the call.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& motion);

  /// What was wrong with the data of all frames so far.
  const Diagnostics& diagnostics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// \throws std::invalid_argument for a camera without a focal length, principal point or pixels.
void validate(const Intrinsics& camera);

/// \throws std::invalid_argument for fewer or more signatures than corners.
void validate(std::span<const Eigen::Vector2f> corners_px, std::span<const Signature> signatures);

}  // namespace lcs
