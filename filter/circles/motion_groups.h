/// \file
/// Splits edges into groups that one motion explains better than two. Normal edges share a plane of
/// inverse depths, rebels a plane of velocities (`PlaneSums`). Groups merge nearest first, if
/// proximity and evidence favour one body. A known ground is a second model for normal groups.
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

/// Standard deviation of a body's slope of inverse depth, relative: the tangent of its slant to the
/// image.
inline constexpr double kSlant = 0.2;

/// Whether a normal edge's depth is known well enough to group it.
inline bool has_depth(const Edge& edge) {
  return edge.depth_ratio_sigma < kSlant * edge.depth_ratio;
}

class MotionGroups {
 public:
  MotionGroups(const Intrinsics& camera, const CircleParameters& parameters,
               const EdgeParameters& edges);

  struct Group {
    std::vector<int>::size_type first, count;  ///< range of its edges in `grouped_`
    bool ground;                               ///< the ground explains it better than a body does
  };

  /// Groups the edges that have a corner and, if normal, a known depth. A group may hold a single
  /// edge. Valid until the next call.
  const std::vector<Group>& group(const std::vector<Edge>& edges, const MotionField& field);
  /// Indices of a group's edges, rising.
  std::span<const int> edges(const Group& group) const {
    return std::span(grouped_).subspan(group.first, group.count);
  }

 private:
  void gather(const std::vector<Edge>& edges, const MotionField& field);
  void link();
  bool is_refused(int a, int b) const;
  void merge(std::vector<Couple>& links, float most);
  void merge();
  double body_evidence(const PlaneSums& sums, double scale) const;
  double ground_evidence(const PlaneSums& sums) const;
  double evidence(const PlaneSums& sums, double scale, double ground) const;

  Intrinsics camera_;
  CircleParameters parameters_;
  EdgeParameters edge_parameters_;

  // Scratch storage of the current call; members, so that a call need not allocate.
  bool rebel_ = false, ground_known_ = false;
  PlanePrior ground_;
  std::vector<int> of_edge_;  // index of each node's edge
  // Of each node: inverse depth and its variance, which is infinite for rebels.
  std::vector<double> depths_, variances_;
  std::vector<PlaneSums> sums_;    // of each node; a root holds its group's sums
  std::vector<double> of_ground_;  // ground_evidence of these sums
  std::vector<double> reach_px_;   // of each node: distance scale to others of its body
  std::vector<Vec2> points_;       // of each node: coordinates along the horizon and upwards
  PointGrid grid_;
  // The nodes in the order of the grid, as columns for `Loops`.
  std::vector<float> reach2_px2_, depth_, variance_;
  std::vector<int> found_;
  std::vector<float> distance2_;
  std::vector<Couple> short_links_, long_links_;
  CoupleSorter sorter_;
  /// The group with which a group was not merged last, and the sizes of both then.
  struct Refusal {
    int other = -1, size = 0, other_size = 0;
  };
  std::vector<Refusal> refused_;  // of each root
  std::vector<int> sizes_;        // of each root
  DisjointSets sets_;
  SetMembers members_;
  std::vector<int> grouped_;
  std::vector<Group> groups_;
};

}  // namespace lcs
