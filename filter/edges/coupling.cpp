#include "filter/edges/coupling.h"

#include <algorithm>
#include <cmath>

#include "filter/edges/gauss.h"
#include "filter/matching/refill.h"

namespace lcs {

double Coupling::weight(const Node& of, const Node& other, double distance2_px2,
                        double noise2_px2) const {
  const double reach = parameters_.coupling_reach_px, share = parameters_.step_share;
  const double longer2 = std::max(of.step_px.squaredNorm(), other.step_px.squaredNorm());
  const double variance =
      noise2_px2 + share * share * longer2 + of.step_variance_px2 + other.step_variance_px2;
  const double exponent =
      distance2_px2 / (reach * reach) + (of.step_px - other.step_px).squaredNorm() / variance;
  return exponent < kFar * kFar ? std::exp(-0.5 * exponent) : 0;
}

const std::vector<double>& Coupling::settle(std::span<const Node> nodes, double noise2_px2) {
  places_.clear();
  beliefs_.clear();
  for (const Node& node : nodes) {
    places_.push_back(node.place_px);
    beliefs_.push_back(node.log_odds);
  }
  grid_.build(places_, parameters_.coupling_reach_px);
  ties_.clear();
  first_.assign(1, 0);
  refill(sums_, nodes.size());
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    grid_.visit_within(places_[i], kFar * parameters_.coupling_reach_px, [&](int j, double apart2) {
      if (j == static_cast<int>(i)) return;
      const double w = weight(nodes[i], nodes[j], apart2, noise2_px2);
      if (w == 0) return;
      ties_.push_back({j, w});
      sums_[i] += w;
    });
    first_.push_back(ties_.size());
  }
  refill(tanh_, nodes.size());
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (std::size_t i = 0; i < nodes.size(); ++i) tanh_[i] = std::tanh(0.5 * beliefs_[i]);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      double sum = 0;
      for (std::size_t k = first_[i]; k < first_[i + 1]; ++k) {
        sum += ties_[k].weight * tanh_[ties_[k].other];
      }
      beliefs_[i] = nodes[i].log_odds;
      if (sums_[i] > 0) beliefs_[i] += parameters_.coupling * sum / sums_[i];
    }
  }
  return beliefs_;
}

int Coupling::nearest(const Vec2& place_px) const {
  int nearest = -1;
  double least2 = 0;
  grid_.visit_within(place_px, parameters_.coupling_reach_px, [&](int j, double apart2) {
    if (nearest < 0 || apart2 < least2 || (apart2 == least2 && beliefs_[j] > beliefs_[nearest])) {
      nearest = j;
      least2 = apart2;
    }
  });
  return nearest;
}

}  // namespace lcs
