/// \file
/// The paper's filter with its rules and tables: presets `lab` and `cars`. filter/EQUATIONS.md
/// lists each equation and its place in this folder.
#pragma once

#include <span>
#include <vector>

#include "filter/ego_motion/intake.h"
#include "filter/filter.h"
#include "filter/line/line.h"
#include "filter/matching/point_grid.h"
#include "filter/paper/paper_circles.h"
#include "filter/paper/paper_edges.h"
#include "filter/paper/paper_squares.h"
#include "filter/paper/parameters.h"
#include "filter/types/layers.h"
#include "filter/types/paper_layers.h"
#include "filter/types/trust.h"

namespace lcs::paper {

/// Feedback of circles and squares to the Line expert: psi, regions whose corners are skipped, and
/// lambda, collectors that group corners for a trusted circle.
class Feedback {
 public:
  explicit Feedback(const TrustRanks& circle_trust) : circle_trust_(circle_trust) {}

  /// Sets psi and lambda of a frame, from its predicted circles and squares. Those that reached
  /// Tr_m become ignored regions; other trusted normal circles become collectors.
  void set_regions(const std::vector<Circle>& normal_circles, const std::vector<Square>& squares,
                   PaperLayers& layers) const;

  /// The index of each corner's collector, -1: none. Overlapping collectors: the nearest one, and
  /// of equally near ones the first.
  /// \return valid until the next call.
  const std::vector<int>& group(std::span<const Collector> lambda, const Chi& chi);

 private:
  TrustRanks circle_trust_;
  PointGrid grid_;               // of chi
  std::vector<double> nearest_;  // of each corner: distance from its collector, px
  std::vector<int> groups_;
};

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
