/// \file
/// Edges in groups, each of what one motion explains better than two: normal ones by the depths of
/// one plane, rebels by velocities of one plane (`PlaneSums`). What lies close together is likely
/// to be of one body, and merges, nearest first, where the evidence does not speak against it.
/// Where the ground is known, it is another thing that a group of normal edges may be.
#pragma once

#include <span>
#include <vector>

#include "filter/circles/circle_parameters.h"
#include "filter/circles/plane_evidence.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/matching/couples.h"
#include "filter/matching/disjoint_sets.h"
#include "filter/matching/point_grid.h"

namespace lcs {

class MotionGroups {
 public:
  MotionGroups(const Intrinsics& camera, const CircleParameters& parameters,
               const EdgeParameters& edges);

  struct Group {
    std::vector<int>::size_type first, count;  ///< of its edges in `edges()`
    bool ground;                               ///< it is rather the ground's than a body's
  };

  /// Groups of those edges that have a corner and, if normal, a depth that is known; of one edge,
  /// too. Valid until the next call.
  const std::vector<Group>& group(const std::vector<Edge>& edges, const MotionField& field);
  /// Indices of the edges of a group, rising.
  std::span<const int> edges(const Group& group) const {
    return std::span(grouped_).subspan(group.first, group.count);
  }

 private:
  void gather(const std::vector<Edge>& edges, const MotionField& field);
  void link();
  void merge();
  double body_evidence(const PlaneSums& sums, double scale) const;
  double ground_evidence(const PlaneSums& sums) const;
  /// Of the likelier of the two.
  double evidence(const PlaneSums& sums, double scale) const;

  Intrinsics camera_;
  CircleParameters parameters_;
  EdgeParameters edge_parameters_;

  // Of the current call; kept for their memory.
  bool rebel_ = false, ground_known_ = false;
  PlanePrior ground_;
  std::vector<int> of_edge_;      // of each node
  std::vector<PlaneSums> sums_;   // of each node, and of the group that a root stands for
  std::vector<double> reach_px_;  // of each node: within which another is likely of its body
  std::vector<Vec2> points_;      // of each node: along the horizon, and upwards
  PointGrid grid_;
  std::vector<Couple> links_;
  DisjointSets sets_;
  SetMembers members_;
  std::vector<int> grouped_;
  std::vector<Group> groups_;
};

}  // namespace lcs
