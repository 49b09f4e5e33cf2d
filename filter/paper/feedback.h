/// \file
/// Feedback of circles and squares to the Line expert: psi, regions whose corners are skipped, and
/// lambda, collectors that group corners for a trusted circle.
#pragma once

#include <span>
#include <vector>

#include "filter/line/line.h"
#include "filter/matching/point_grid.h"
#include "filter/types/layers.h"
#include "filter/types/paper_layers.h"
#include "filter/types/trust.h"

namespace lcs::paper {

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

}  // namespace lcs::paper
