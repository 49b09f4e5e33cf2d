#include "filter/edges/coupling.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "filter/edges/explanation.h"
#include "filter/edges/gauss.h"
#include "filter/vectors/refill.h"
#include "filter/vectors/vectors.h"

namespace lcs {

/// b: weight of a neighbour at the cut-off distance.
const double kBeyond = std::exp(-0.5 * kFar * kFar);

/// Puts the nodes into columns.
void Coupling::place(std::span<const Node> nodes, const Neighbourhood& around) {
  for (auto* column : {&step_x_px_, &step_y_px_, &reach2_px2_, &length2_px2_, &variance_px2_,
                       &log_odds_, &tanh_, &sums_, &pulls_}) {
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
      const std::size_t most = end + (last - first) / kLanes + 1;
      if (starts_.size() < most) {
        starts_.resize(2 * most);
        weights_.resize(kLanes * starts_.size());
      }
      end += loops().ties(nodes, k, static_cast<float>(noise2_px2), first, last,
                          starts_.data() + end, weights_.data() + kLanes * end);
    });
  }
  first_.push_back(end);
}

const std::vector<double>& Coupling::settle(std::span<const Node> nodes,
                                            const Neighbourhood& around, double noise2_px2,
                                            double most) {
  place(nodes, around);
  tie(around.grid(), noise2_px2);
  const std::size_t count = nodes.size();
  const Ties ties = {first_.data(), starts_.data(), weights_.data()};
  std::fill_n(tanh_.begin(), count, 1.0F);
  loops().tied_sums(ties, tanh_.data(), count, sums_.data());
  const auto beyond = static_cast<float>(kBeyond), J = static_cast<float>(most);
  copy_over(log_odds_, coupled_);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    loops().half_tanh(coupled_.data(), tanh_.data(), count);
    loops().tied_sums(ties, tanh_.data(), count, pulls_.data());
    for (std::size_t k = 0; k < count; ++k) {
      if (reach2_px2_[k] < 0) continue;
      coupled_[k] = log_odds_[k] + J * (pulls_[k] - beyond) / (sums_[k] + beyond);
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
    double least2 = std::numeric_limits<double>::infinity();
    grid.visit_within(nodes[i].place_px, reach_px_[i], [&](int j, double apart2) {
      if (!nodes[j].tells || apart2 > least2 || apart2 > reach_px_[j] * reach_px_[j]) return;
      beliefs_[i] = apart2 < least2 ? beliefs_[j] : std::max(beliefs_[i], beliefs_[j]);
      least2 = apart2;
    });
  }
}

std::vector<Voice> Coupling::voices(int node, const PointGrid& grid) const {
  std::vector<float> one(grid.size() + kLanes), weights(grid.size() + kLanes);
  for (std::size_t k = 0; k < grid.size(); ++k) one[k] = grid.index_at(k) == node ? 1 : 0;
  loops().tied_sums({first_.data(), starts_.data(), weights_.data()}, one.data(), grid.size(),
                    weights.data());
  std::vector<Voice> voices;
  for (std::size_t k = 0; k < grid.size(); ++k) {
    if (weights[k] > 0) voices.push_back({grid.index_at(k), weights[k], tanh_[k]});
  }
  std::ranges::stable_sort(voices, std::ranges::greater(), &Voice::weight);
  return voices;
}

}  // namespace lcs
