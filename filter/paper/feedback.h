/// \file
/// What circles and squares hand back to the Line expert: psi, the regions whose corners are not
/// looked at, and lambda, the collectors that group corners for a trusted circle.
#pragma once

#include <span>
#include <vector>

#include "filter/layers.h"
#include "filter/line/line.h"
#include "filter/matching/point_grid.h"
#include "filter/trust.h"

namespace lcs::paper {

class Feedback {
 public:
  explicit Feedback(const TrustRanks& circle_trust) : circle_trust_(circle_trust) {}

  struct Regions {
    std::vector<IgnoreRegion> ignored;  ///< psi
    std::vector<Collector> collectors;  ///< lambda
  };

  /// The regions of a frame, by its predicted circles and squares: those that reached Tr_m are
  /// ignored, the other trusted normal circles collect.
  /// \return valid until the next call.
  const Regions& regions(const std::vector<Circle>& normal_circles,
                         const std::vector<Square>& squares);

  /// For each corner of chi the collector that it falls into, -1: none. Of several it is the
  /// nearest, and of equally near ones the first.
  /// \return valid until the next call.
  const std::vector<int>& group(std::span<const Collector> lambda, const Chi& chi);

 private:
  TrustRanks circle_trust_;
  Regions regions_;
  PointGrid grid_;               // of chi
  std::vector<double> nearest_;  // distance of each corner from its collector
  std::vector<int> groups_;
};

}  // namespace lcs::paper
