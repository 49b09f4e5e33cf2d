/// \file
/// Lets neighbouring corners support each other: their log odds are coupled as in a mean field,
///
///   m_i = L_i + J sum_j w_ij tanh(m_j / 2) / sum_j w_ij,
///
/// where w falls with the distance in the image and with how unlike their motions are.
#pragma once

#include <span>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/matching/point_grid.h"
#include "filter/parameters.h"

namespace lcs {

class Coupling {
 public:
  explicit Coupling(const HypothesisParameters& parameters) : parameters_(parameters) {}

  struct Node {
    Vec2 place_px;
    double log_odds;
    Vec2 step_px;              ///< of a frame, rotation removed
    double step_variance_px2;  ///< on one axis
  };

  /// \param noise2_px2 variance of a corner's place on an axis. \return m of each.
  const std::vector<double>& settle(std::span<const Node> nodes, double noise2_px2);

  /// Of the nodes last settled the nearest to a place, within their reach; of equally near ones the
  /// likeliest to move. -1: none.
  int nearest(const Vec2& place_px) const;

 private:
  double weight(const Node& of, const Node& other, double distance2_px2, double noise2_px2) const;

  HypothesisParameters parameters_;
  PointGrid grid_;
  std::vector<Vec2> places_;
  struct Tie {
    int other;
    double weight;
  };
  std::vector<Tie> ties_;  // by node
  std::vector<std::size_t> first_;
  std::vector<double> sums_;
  std::vector<double> tanh_, beliefs_;
};

}  // namespace lcs
