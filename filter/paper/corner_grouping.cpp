#include "filter/paper/corner_grouping.h"

#include "filter/matching/refill.h"

namespace lcs {
namespace {

/// Of the grid of corners: about as wide as a collector.
constexpr double kCell_px = 32;

}  // namespace

/// Few corners lie in each collector, so that they are looked for from there.
void CornerGrouping::group(std::span<const Collector> lambda, Chi& chi) {
  refill(chi.groups, chi.size(), -1);
  if (lambda.empty()) return;
  grid_.build(chi.locations, kCell_px);
  refill(nearest_, chi.size());
  for (std::size_t c = 0; c < lambda.size(); ++c) {
    // A hair farther, for the distance is compared and not its square.
    grid_.visit_within(lambda[c].location, 1.001 * lambda[c].radius, [&](int i, double) {
      const double distance = (chi.locations[i] - lambda[c].location).norm();
      if (distance > lambda[c].radius) return;
      if (chi.groups[i] >= 0 && !(distance < nearest_[i])) return;
      chi.groups[i] = static_cast<int>(c);
      nearest_[i] = distance;
    });
  }
}

}  // namespace lcs
