/// \file
/// The paper's filter with its rules and tables: presets `lab` and `cars`. filter/EQUATIONS.md
/// lists each equation and its place in this folder.
#pragma once

#include <span>
#include <vector>

#include "filter/ego_motion/intake.h"
#include "filter/filter.h"
#include "filter/paper/feedback.h"
#include "filter/paper/paper_circles.h"
#include "filter/paper/paper_edges.h"
#include "filter/paper/paper_squares.h"
#include "filter/paper/parameters.h"

namespace lcs::paper {

/// Like `lcs::Filter`, with the same guarantees.
class PaperFilter {
 public:
  explicit PaperFilter(const Intrinsics& camera, const PaperParameters& parameters = {});

  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px, const EgoMotion& motion) {
    return take(corners_px, {}, motion);
  }

  /// \param signatures used only to order corners at the same place: the paper has no descriptors.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& motion) {
    lcs::validate(corners_px, signatures);
    return take(corners_px, signatures, motion);
  }

  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  const FrameResult& take(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& told);

  Intrinsics camera_;
  FieldParameters field_;
  Intake intake_;
  Diagnostics diagnostics_;
  Feedback feedback_;
  LineExpert line_;
  PaperEdges edge_expert_;
  PaperCircles circle_expert_;
  PaperSquares square_expert_;
  EdgeLayer edges_;
  CircleExpert::Result circles_;
  std::vector<Square> squares_;
  FrameResult result_;
};

}  // namespace lcs::paper
