/// \file
/// Line expert, second part, of the paper's rule: corners are grouped by lambda, the collectors of
/// trusted circles.
#pragma once

#include <span>
#include <vector>

#include "filter/layers.h"
#include "filter/line/line.h"
#include "filter/matching/point_grid.h"

namespace lcs {

/// Sets chi's groups. Of the collectors that a corner falls into it takes the nearest, and of
/// equals the first.
class CornerGrouping {
 public:
  void group(std::span<const Collector> lambda, Chi& chi);

 private:
  PointGrid grid_;               // of chi
  std::vector<double> nearest_;  // distance of each corner from its collector
};

}  // namespace lcs
