/// \file
/// Splits edges into groups that one motion explains better than two. Normal edges share a plane of
/// inverse depths, rebels a plane of velocities (`PlaneSums`). Groups merge nearest first, if
/// proximity and evidence favour one body. A known ground is a second model for normal groups.
#pragma once

#include <Eigen/Core>
#include <cmath>
#include <span>
#include <vector>

#include "filter/circles/circle_parameters.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/camera.h"
#include "filter/kinematics/motion_field.h"
#include "filter/matching/couples.h"
#include "filter/matching/disjoint_sets.h"
#include "filter/matching/members.h"
#include "filter/matching/point_grid.h"
#include "filter/types/layers.h"

namespace lcs {

// ---- Evidence (marginal likelihood) that one plane explains measurements at many image places, by
// Bayesian linear regression: y = a + B h + noise, h = (x - c) / f, with a normal prior on a and
// B. Inverse depths of a flat body form such a plane. So do image velocities of a rigid body, to
// first order.

/// Coefficients of (1, h) for each of up to two measured values.
using PlaneCoefficients = Eigen::Matrix<double, 3, 2>;

/// Prior of a plane: mean coefficients, standard deviation of the level a at the centroid of the
/// measurements, and of each slope.
struct PlanePrior {
  PlaneCoefficients mean = PlaneCoefficients::Zero();
  double level_sigma = 1, slope_sigma = 1;
};

/// Sufficient statistics of measurements. Additive: a group's are the sum of its members'.
class PlaneSums {
 public:
  PlaneSums() = default;
  /// One measurement. \param h its place. \param sigma of the noise of each value, > 0.
  PlaneSums(const Vec2& h, const Vec2& value, double sigma);

  PlaneSums& operator+=(const PlaneSums& other);

  /// Weighted root mean square of the measured values.
  double magnitude() const { return std::sqrt(values2_ / squares_(0, 0)); }

  /// ln p(measurements | prior), without the terms that do not depend on the prior.
  /// \param values number of values at each place, 1 or 2; the second is 0 if there is one.
  double evidence(const PlanePrior& prior, int values) const;

 private:
  template <int kValues>
  double evidence_of(const PlanePrior& prior) const;

  Eigen::Matrix3d squares_ = Eigen::Matrix3d::Zero();       // sum of q (1, h) (1, h)^T
  PlaneCoefficients products_ = PlaneCoefficients::Zero();  // sum of q (1, h) y^T
  double values2_ = 0;                                      // sum of q |y|^2
};

// ---- The groups

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
  Members members_;
  std::vector<int> grouped_;
  std::vector<Group> groups_;
};

}  // namespace lcs
