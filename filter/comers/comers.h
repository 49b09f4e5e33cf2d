/// \file
/// Comers: bodies that approach along the line of sight. At constant speed their corners move as
/// static points that are nearer, and are normal edges. A comer's circle is thus taken for a nearer
/// body whose foot floats above the ground (filter/MODEL.md, "Comers").
#pragma once

#include <span>
#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/comers/gap.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/matching/point_grid.h"
#include "filter/reason.h"

namespace lcs {

struct ComerParameters {
  double hanging = 0.003;    ///< share of static circles that hang free; 1 switches comers off
  double count_power = 0.3;  ///< power of the number of edges that an empty gap is held against
  double memory = 2;         ///< frames over which the log odds of a circle fade
};

class Comers {
 public:
  Comers(const Intrinsics& camera, const ComerParameters& parameters,
         const CircleParameters& circle, const EdgeParameters& edge)
      : camera_(camera), parameters_(parameters), circle_(circle), edge_(edge) {}

  struct Result {
    BothKinds<Edge> edges;  ///< with the comers' edges among the rebels; by rising id
    CircleExpert::Result circles;
    /// Corners that become rebels, as indices in the caller's list: of called edges, and of those
    /// that have no known depth and are nearest to a called edge.
    std::vector<int> called, inherited;
    std::vector<GapSeen> gaps;  ///< all gaps that were looked at, with the answers
  };

  /// \param corners_px,reasons of the frame, in the caller's order.
  /// \return valid until the next call; null without a ground or while the camera stands still.
  const Result* step(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
                     std::span<const Eigen::Vector2f> corners_px, std::span<const Reason> reasons,
                     const MotionField& field, GapView& view);

  /// Drops all log odds.
  void forget() { beliefs_.clear(); }

 private:
  /// A normal edge in terms of the ground.
  struct Seen {
    double inverse_depth_pm, sigma_pm;
    double down;   ///< fall of its ray, per unit of depth
    double along;  ///< the same to the right
    bool ground;   ///< it may be a point of the ground
    bool seen;     ///< it has a corner in this frame, and a depth
  };
  /// Log odds that an edge's circle comes.
  struct Belief {
    Id edge;
    double log_odds;
  };

  void find_ground_coordinates(const std::vector<Edge>& edges, const MotionField& field);
  double evidence(Id circle, std::span<const int> members, const MotionField& field, GapView& view);
  void believe(const std::vector<Edge>& edges, const CircleExpert::Result& circles,
               const MotionField& field, GapView& view);
  void relabel(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
               const MotionField& field);
  void inherit(const std::vector<Edge>& edges, std::span<const Eigen::Vector2f> corners_px,
               std::span<const Reason> reasons);

  Intrinsics camera_;
  ComerParameters parameters_;
  CircleParameters circle_;
  EdgeParameters edge_;
  std::vector<Belief> beliefs_;  // of normal edges, by rising id
  Result result_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<Seen> seen_;     // of each normal edge
  std::vector<double> moves_;  // of each normal edge: log odds that it comes, if its circle was asked
  std::vector<Belief> next_;
  std::vector<double> depths_;
  std::vector<int> first_, grouped_, known_, place_, members_;
  std::vector<Vec2> places_;
  PointGrid grid_;
};

}  // namespace lcs
