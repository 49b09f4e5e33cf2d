/// \file
/// The LCS filter. Input: corners of a frame and ego-motion. Output: layers, and a verdict for each
/// corner. filter/MODEL.md specifies it; `filter/paper/` has the paper's own filter.
#pragma once

#include <memory>
#include <optional>
#include <span>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/parameters.h"
#include "filter/types/diagnostics.h"
#include "filter/types/frame_result.h"
#include "filter/types/gap.h"
#include "filter/types/signature.h"

namespace lcs {

struct Explanation;

/// Deterministic: the same corners, signatures and motions give the same bits, for any order of the
/// corners of a frame.
///
/// Bad data never throw and have no lasting effect. Invalid corners are dropped. If the time or
/// motion since the last frame is unknown, the filter resets: from that frame on its results equal
/// the results of a new filter, except for the ids.
class Filter {
 public:
  /// \throws std::invalid_argument for parameters out of range, or an invalid camera.
  explicit Filter(const Intrinsics& camera, const Parameters& parameters = {});
  ~Filter();
  Filter(Filter&&) noexcept;
  Filter& operator=(Filter&&) noexcept;

  /// \param corners_px of this frame, pixels.
  /// \param motion since the last frame.
  /// \param view looks at this frame's picture for the filter; null: no bodies that approach at
  ///   constant speed are found.
  /// \return the filter's own storage: valid until the next step.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px, const EgoMotion& motion,
                          GapView* view = nullptr);

  /// \param signatures one for each corner, in their order.
  /// \throws std::invalid_argument if the counts of signatures and corners differ; the filter is
  ///   then unchanged.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& motion,
                          GapView* view = nullptr);

  /// The numbers behind the verdict on a corner of the last frame (`edges/explanation.h`).
  /// \param corner index in the caller's list. \return absent if the filter has left it out.
  std::optional<Explanation> explain(int corner) const;

  /// Counts of the faults in the data so far.
  const Diagnostics& diagnostics() const;

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// \throws std::invalid_argument for a camera without a focal length, principal point or pixels.
void validate(const Intrinsics& camera);

/// \throws std::invalid_argument if the counts of signatures and corners differ.
void validate(std::span<const Eigen::Vector2f> corners_px, std::span<const Signature> signatures);

}  // namespace lcs
