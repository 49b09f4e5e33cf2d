/// \file
/// Couples the log odds of neighbouring corners in a mean field, so that they support each other:
///
///   m_i = L_i + J [sum_j w_ij tanh(m_j / 2) - b] / [sum_j w_ij + b],
///
/// w falls with the difference of their motions and with their distance, in units of r, the
/// distance of the `neighbours`-th nearest node (Zelnik-Manor, Perona: Self-tuning spectral
/// clustering, 2004). b is the weight of a virtual static neighbour at the cut-off distance.
/// MODEL.md (18) and (19) call w k, and b k_0.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "filter/edges/edge_parameters.h"
#include "filter/edges/neighbourhood.h"
#include "filter/kinematics/camera.h"

namespace lcs {

struct Voice;

class Coupling {
 public:
  explicit Coupling(const EdgeParameters& parameters) : parameters_(parameters) {}

  struct Node {
    Vec2 place_px;
    double log_odds;
    Vec2 step_px;              ///< in this frame, rotation removed
    double step_variance_px2;  ///< on one axis
    bool tells = true;         ///< false: seen once, so its motion is unknown
  };

  /// \param around the neighbours of the nodes' places.
  /// \param noise2_px2 variance of a corner's place on an axis, px^2.
  /// \param most J: the most log odds that neighbours add.
  /// \return m of each node. A node that does not tell takes the m of its nearest node that does,
  ///   if each lies within the other's r; of equally near ones the largest. Else its own log odds.
  const std::vector<double>& settle(std::span<const Node> nodes, const Neighbourhood& around,
                                    double noise2_px2, double most);

  /// What a node was told by each node that it is tied to, in the last `settle`; heaviest first.
  /// \param grid of its neighbourhood.
  std::vector<Voice> voices(int node, const PointGrid& grid) const;

 private:
  void place(std::span<const Node> nodes, const Neighbourhood& around);
  void tie(const PointGrid& grid, double noise2_px2);
  void follow(std::span<const Node> nodes, const PointGrid& grid);

  EdgeParameters parameters_;
  std::vector<double> reach_px_, beliefs_;  // of each node

  // The nodes in the order of the grid, as columns for `Loops`. A node that does not tell has
  // a negative `reach2_px2_`, and no ties.
  std::vector<float> step_x_px_, step_y_px_, reach2_px2_, length2_px2_, variance_px2_;
  std::vector<float> log_odds_, coupled_, tanh_;
  std::vector<float> sums_, pulls_;  // sum of weights, weighted sum of tanh
  // The columns of `Ties`.
  std::vector<std::size_t> first_;
  std::vector<std::uint32_t> starts_;
  std::vector<float> weights_;
};

}  // namespace lcs
