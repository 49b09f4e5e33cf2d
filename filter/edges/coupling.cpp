#include "filter/edges/coupling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "filter/edges/gauss.h"
#include "filter/matching/refill.h"
#include "filter/vectors/vectors.h"

namespace lcs {

constexpr double kInfinity_px = std::numeric_limits<double>::infinity();

/// b: weight of a neighbour at the cut-off distance.
const double kBeyond = std::exp(-0.5 * kFar * kFar);

/// Puts the nodes into columns.
void Coupling::place(std::span<const Node> nodes, const Neighbourhood& around) {
  for (auto* column : {&step_x_px_, &step_y_px_, &reach2_px2_, &length2_px2_, &variance_px2_,
                       &log_odds_, &tanh_, &sums_}) {
    refill_column(*column, nodes.size());
  }
  refill(reach_px_, nodes.size());
  refill(beliefs_, nodes.size());
  const auto share2 = static_cast<float>(parameters_.step_share * parameters_.step_share);
  for (std::size_t k = 0; k < nodes.size(); ++k) {
    const auto i = static_cast<std::size_t>(around.grid().index_at(k));
    const Node& node = nodes[i];
    reach_px_[i] = around.reach_px(i);
    step_x_px_[k] = static_cast<float>(node.step_px.x());
    step_y_px_[k] = static_cast<float>(node.step_px.y());
    reach2_px2_[k] = node.tells ? static_cast<float>(reach_px_[i] * reach_px_[i]) : -1;
    length2_px2_[k] = share2 * static_cast<float>(node.step_px.squaredNorm());
    variance_px2_[k] = static_cast<float>(node.step_variance_px2);
    log_odds_[k] = static_cast<float>(node.log_odds);
  }
}

/// Finds the ties, and their weights.
void Coupling::tie(const PointGrid& grid, double noise2_px2) {
  const TieColumns nodes = {grid.x_px(),          grid.y_px(),
                            step_x_px_.data(),    step_y_px_.data(),
                            reach2_px2_.data(),   length2_px2_.data(),
                            variance_px2_.data(), static_cast<float>(kFar * kFar)};
  std::size_t end = 0;
  first_.clear();
  for (std::size_t k = 0; k < grid.size(); ++k) {
    first_.push_back(end);
    if (reach2_px2_[k] < 0) continue;
    grid.visit_runs_after(k, kFar * std::sqrt(reach2_px2_[k]), [&](auto first, auto last) {
      if (weights_.size() < end + (last - first) + kLanes) {
        weights_.resize(2 * (end + (last - first) + kLanes));
        others_.resize(weights_.size());
      }
      end += loops().ties(nodes, k, static_cast<float>(noise2_px2), first, last,
                          others_.data() + end, weights_.data() + end);
    });
  }
  first_.push_back(end);
  loops().exponentials(weights_.data(), end, -0.5F);
}

const std::vector<double>& Coupling::settle(std::span<const Node> nodes,
                                            const Neighbourhood& around, double noise2_px2) {
  place(nodes, around);
  tie(around.grid(), noise2_px2);
  const std::size_t count = nodes.size();
  // Calls `add(other, weight)` for each tie of a node.
  const auto visit_ties = [&](std::size_t k, auto&& add) {
    for (std::size_t t = first_[k]; t < first_[k + 1]; ++t) {
      add(static_cast<std::size_t>(others_[t]), weights_[t]);
    }
  };
  for (std::size_t k = 0; k < count; ++k) {
    float sum = 0;
    visit_ties(k, [&](std::size_t other, float weight) {
      sum += weight;
      sums_[other] += weight;
    });
    sums_[k] += sum;
  }
  const auto beyond = static_cast<float>(kBeyond), most = static_cast<float>(parameters_.coupling);
  copy_over(log_odds_, coupled_);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    loops().half_tanh(coupled_.data(), tanh_.data(), count);
    refill(pulls_, count);
    for (std::size_t k = 0; k < count; ++k) {
      const float own = tanh_[k];
      float pull = 0;
      visit_ties(k, [&](std::size_t other, float weight) {
        pull += weight * tanh_[other];
        pulls_[other] += weight * own;
      });
      pull += pulls_[k];
      if (reach2_px2_[k] < 0) continue;
      coupled_[k] = log_odds_[k] + most * (pull - beyond) / (sums_[k] + beyond);
    }
  }
  for (std::size_t k = 0; k < count; ++k) {
    beliefs_[static_cast<std::size_t>(around.grid().index_at(k))] = coupled_[k];
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
