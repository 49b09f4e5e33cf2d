/// \file
/// Line expert: selects and orders the corners of a frame for the filter.
#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <span>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/types/diagnostics.h"
#include "filter/types/frame_result.h"
#include "filter/types/signature.h"

namespace lcs {

struct LineParameters {
  /// Maximum number of corners; those nearest to the principal point are kept. Bounds memory.
  int max_corners = 20000;
};

/// chi after the Line expert: the corners that the filter uses, nearest to the principal point
/// first. The order does not depend on the caller's.
struct Chi {
  std::vector<Vec2> locations;        ///< px
  std::vector<int> sources;           ///< index of each corner in the caller's list
  std::vector<Signature> signatures;  ///< of each corner; empty if the caller gives none

  /// A corner at the same place as a corner of chi. It gets that corner's verdict.
  struct Repeat {
    int source, of_source;  ///< indices in the caller's corners
  };
  std::vector<Repeat> repeats;

  /// Reason to reject each of the caller's corners; `unknown` for corners of chi and repeats.
  std::vector<Reason> rejected;

  std::size_t size() const { return locations.size(); }
};

/// Whether x is inside a region of psi, border included.
bool contains(const IgnoreRegion& region, const Vec2& x);
bool inside_any(std::span<const IgnoreRegion> regions, const Vec2& x);

class LineExpert {
 public:
  LineExpert(const Intrinsics& camera, const LineParameters& parameters)
      : centre_px_(camera.centre_px),
        picture_{camera.width_px, camera.height_px},
        max_corners_(static_cast<std::size_t>(parameters.max_corners)) {}

  /// \param signatures one for each corner, or empty.
  /// \param psi corners inside these regions are rejected.
  /// \return valid until the next call.
  const Chi& collect(std::span<const Eigen::Vector2f> corners_px,
                     std::span<const Signature> signatures, std::span<const IgnoreRegion> psi);

 private:
  Vec2 centre_px_;
  Pixels picture_;
  std::size_t max_corners_;
  struct ParameterEntry {
    double distance2;
    Vec2 location;
    int source;
  };
  std::vector<ParameterEntry> entries_;
  Chi chi_;
};

/// Counts the rejected and repeated corners.
void count_rejected(const Chi& chi, Diagnostics& diagnostics);

/// Sets verdict and reason of each of the caller's corners. Rejected corners are `ignored` inside
/// psi and `pending` elsewhere. A repeat gets the verdict and reason of the corner at its place.
/// \param verdicts, reasons, log_odds one for each corner of chi; no `log_odds`: none are known.
void assign_verdicts(const Chi& chi, std::span<const Verdict> verdicts,
                     std::span<const Reason> reasons, std::span<const float> log_odds,
                     FrameResult& result);

/// Makes corners, and their repeats, rebels.
void assign_rebels(const Chi& chi, std::span<const CornerOdds> corners, Reason reason,
                   FrameResult& result);

}  // namespace lcs
