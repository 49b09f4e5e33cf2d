#include "filter/edges/coupling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "filter/edges/gauss.h"
#include "filter/matching/refill.h"

namespace lcs {

constexpr double kInfinity_px = std::numeric_limits<double>::infinity();

/// b: weight of a neighbour at the cut-off distance.
const double kBeyond = std::exp(-0.5 * kFar * kFar);

/// Weight of the tie between two nodes. The squares of their reaches add.
double Coupling::weight(int i, int j, std::span<const Node> nodes, double distance2_px2,
                        double noise2_px2) const {
  const Node &a = nodes[i], &b = nodes[j];
  const double share = parameters_.step_share;
  const double longer2 = std::max(a.step_px.squaredNorm(), b.step_px.squaredNorm());
  const double variance =
      noise2_px2 + share * share * longer2 + a.step_variance_px2 + b.step_variance_px2;
  const double exponent =
      distance2_px2 / (reach_px_[i] * reach_px_[i] + reach_px_[j] * reach_px_[j]) +
      (a.step_px - b.step_px).squaredNorm() / variance;
  return exponent < kFar * kFar ? std::exp(-0.5 * exponent) : 0;
}

const std::vector<double>& Coupling::settle(std::span<const Node> nodes,
                                            const Neighbourhood& around, double noise2_px2) {
  beliefs_.clear();
  reach_px_.clear();
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    beliefs_.push_back(nodes[i].log_odds);
    reach_px_.push_back(around.reach_px(i));
  }
  ties_.clear();
  refill(sums_, nodes.size());
  around.grid().visit_pairs(
      kInfinity_px, [&](int i) { return kFar * reach_px_[i]; },
      [&](int i, int j, double apart2) {
        if (!nodes[i].tells || !nodes[j].tells) return;
        if (apart2 > kFar * kFar * reach_px_[j] * reach_px_[j]) return;
        const double w = weight(i, j, nodes, apart2, noise2_px2);
        if (w == 0) return;
        ties_.push_back({i, j, w});
        sums_[i] += w;
        sums_[j] += w;
      });
  refill(tanh_, nodes.size());
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    for (std::size_t i = 0; i < nodes.size(); ++i) tanh_[i] = std::tanh(0.5 * beliefs_[i]);
    refill(pulls_, nodes.size());
    for (const Tie& tie : ties_) {
      pulls_[tie.a] += tie.weight * tanh_[tie.b];
      pulls_[tie.b] += tie.weight * tanh_[tie.a];
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      beliefs_[i] = nodes[i].log_odds;
      if (!nodes[i].tells) continue;
      beliefs_[i] += parameters_.coupling * (pulls_[i] - kBeyond) / (sums_[i] + kBeyond);
    }
  }
  follow(nodes, around.grid());
  return beliefs_;
}

/// A node without a motion takes the belief of its nearest node with one; of equally near ones the
/// largest.
void Coupling::follow(std::span<const Node> nodes, const PointGrid& grid) {
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (nodes[i].tells) continue;
    double least2 = kInfinity_px;
    grid.visit_within(nodes[i].place_px, reach_px_[i], [&](int j, double apart2) {
      if (!nodes[j].tells || apart2 > least2 || apart2 > reach_px_[j] * reach_px_[j]) return;
      beliefs_[i] = apart2 < least2 ? beliefs_[j] : std::max(beliefs_[i], beliefs_[j]);
      least2 = apart2;
    });
  }
}

}  // namespace lcs
