/// \file
/// Comers: bodies that approach along the line of sight. At constant speed their corners move as
/// nearer static points do, and are normal edges. A comer's circle looks like a nearer body whose
/// foot floats above the ground (filter/MODEL.md, "Comers").
#pragma once

#include <span>
#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/layers.h"
#include "filter/matching/point_grid.h"
#include "filter/radial/comer_parameters.h"
#include "filter/radial/gap.h"
#include "filter/radial/ground_view.h"
#include "filter/reason.h"

namespace lcs {

class Comers {
 public:
  Comers(const Intrinsics& camera, const ComerParameters& parameters,
         const CircleParameters& circle, const EdgeParameters& edge)
      : camera_(camera), parameters_(parameters), circle_(circle), edge_(edge) {}

  struct Result {
    /// Log odds of each normal edge that it comes. An edge in no circle, or of no known depth, has
    /// those of the nearest edge with a known depth; all edges of a circle have the same.
    std::vector<double> odds;
    /// Corners without an edge that are nearest to one that comes, as indices in the caller's list.
    std::vector<int> inherited;
    std::vector<GapSeen> gaps;  ///< all gaps that were looked at, with the answers
  };

  /// \param edges,seen the normal edges. \param circles of all edges.
  /// \param corners_px,reasons of the frame, in the caller's order.
  /// \return valid until the next call.
  const Result& step(const std::vector<Edge>& edges, std::span<const GroundEdge> seen,
                     const CircleExpert::Result& circles,
                     std::span<const Eigen::Vector2f> corners_px, std::span<const Reason> reasons,
                     const MotionField& field, const GroundView& ground, GapView& view);

  /// Drops all log odds.
  void forget() { beliefs_.clear(); }

 private:
  /// Log odds that an edge's circle comes.
  struct Belief {
    Id edge;
    double log_odds;
  };

  void recall(const std::vector<Edge>& edges);
  void believe(std::span<const GroundEdge> seen, const CircleExpert::Result& circles,
               const MotionField& field, const GroundView& ground, GapView& view);
  double evidence(Id circle, std::span<const int> members, std::span<const GroundEdge> seen,
                  const MotionField& field, const GroundView& ground, GapView& view);
  void inherit(const std::vector<Edge>& edges, std::span<const Eigen::Vector2f> corners_px,
               std::span<const Reason> reasons);

  Intrinsics camera_;
  ComerParameters parameters_;
  CircleParameters circle_;
  EdgeParameters edge_;
  std::vector<Belief> beliefs_;  // of normal edges, by rising id
  Result result_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<Belief> next_;
  std::vector<double> depths_pm_;
  std::vector<int> first_, grouped_, known_;
  std::vector<Vec2> places_;
  PointGrid grid_;
};

}  // namespace lcs
