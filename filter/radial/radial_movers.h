/// \file
/// Movers along the line of sight, which the edges alone cannot tell from static points: comers and
/// goers. Works on the edges and circles of a frame, after the circle expert.
#pragma once

#include <span>
#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/matching/members.h"
#include "filter/matching/point_grid.h"
#include "filter/radial/comer_parameters.h"
#include "filter/radial/ground_view.h"
#include "filter/types/frame_result.h"
#include "filter/types/gap.h"
#include "filter/types/layers.h"
#include "filter/types/reason.h"

namespace lcs {

/// A frame in which radial movers are looked for.
struct RadialFrame {
  const BothKinds<Edge>& edges;
  const CircleExpert::Result& circles;  ///< of all edges
  std::span<const GroundEdge> seen;     ///< the normal edges
  /// \name Of each corner, in the caller's order.
  ///@{
  std::span<const Eigen::Vector2f> corners_px;
  std::span<const Reason> reasons;
  ///@}
  const MotionField& field;
  const GroundView& ground;
};

/// Comers: bodies that approach along the line of sight. At constant speed their corners move as
/// nearer static points do, and are normal edges. A comer's circle looks like a nearer body whose
/// foot floats above the ground (filter/MODEL.md, "Comers").
class Comers {
 public:
  Comers(const Intrinsics& camera, const ComerParameters& parameters,
         const CircleParameters& circle, const EdgeParameters& edge)
      : camera_(camera), parameters_(parameters), circle_(circle), edge_(edge) {}

  struct Result {
    /// Log odds that each normal edge approaches. An edge in no circle, or of no known depth, has
    /// the log odds of the nearest edge with a known depth; all edges of a circle have the same.
    std::vector<double> odds;
    /// Corners without an edge that are nearest to one that comes.
    std::vector<CornerOdds> inherited;
    std::vector<GapSeen> gaps;  ///< all gaps that were looked at, with the answers
  };

  /// \return valid until the next call.
  const Result& step(const RadialFrame& frame, GapView& view);

  /// Drops all log odds.
  void forget() { beliefs_.clear(); }

 private:
  /// Log odds that an edge's circle comes.
  struct Belief {
    Id edge;
    double log_odds;
  };

  void recall(const std::vector<Edge>& edges);
  void believe(const RadialFrame& frame, GapView& view);
  double evidence(Id circle, std::span<const int> members, const RadialFrame& frame, GapView& view);
  void inherit(const RadialFrame& frame);

  Intrinsics camera_;
  ComerParameters parameters_;
  CircleParameters circle_;
  EdgeParameters edge_;
  std::vector<Belief> beliefs_;  // of normal edges, by rising id
  Result result_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<Belief> next_;
  std::vector<double> depths_pm_;
  Members members_;  // of each normal circle
  std::vector<int> known_;
  std::vector<Vec2> places_;
  PointGrid grid_;
};

/// Goers: bodies that go away or keep pace. Seen as static, such a body is farther than the ground
/// on which it stands. Its lower edges are below the ground's bound (3) and become rebels; its
/// upper ones move as distant static points do. They join the circle of the lower ones
/// (filter/MODEL.md, "Goers").
class Goers {
 public:
  Goers(const Intrinsics& camera, const CircleParameters& circle, const EdgeParameters& edge)
      : camera_(camera), circle_(circle), edge_(edge) {}

  struct Result {
    std::vector<int> circle;   ///< of each normal edge: the rebel circle that it joins, or -1
    std::vector<double> odds;  ///< for an edge that joins a circle: log odds that it recedes
  };

  /// \return valid until the next call.
  const Result& step(const RadialFrame& frame);

 private:
  /// A place on a body, in coordinates of the ground's view.
  using Place = Vec2;

  void join(int circle, const RadialFrame& frame);

  Intrinsics camera_;
  CircleParameters circle_;
  EdgeParameters edge_;
  Result result_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<double> apparent_pm_, across_px_, sorted_;
  std::vector<Place> front_, next_;
  std::vector<int> near_;
};

/// Makes rebels of normal edges that belong to radial movers, and of their circles.
class Relabel {
 public:
  struct Result {
    BothKinds<Edge> edges;  ///< by rising id
    CircleExpert::Result circles;
    /// Corners of the edges that became rebels, with their circle, or by joining another circle.
    std::vector<CornerOdds> came, went;
  };

  /// \param odds of each normal edge: log odds that it moves. Those above 0 become rebels. The
  ///   edges of a normal circle agree, unless they join another circle.
  /// \param joined of each normal edge: the rebel circle that it joins, or -1.
  /// \return valid until the next call.
  const Result& step(const RadialFrame& frame, std::span<const double> odds,
                     std::span<const int> joined, const TrustRanks& trust);

 private:
  Result result_;
  // Scratch storage of the current frame; members, so that a frame need not allocate.
  std::vector<int> left_, moved_, place_;
  Members members_;
};

class RadialMovers {
 public:
  struct Result {
    /// The edges and circles, radial movers among the rebels; null: there are no radial movers.
    const Relabel::Result* moved = nullptr;
    const Comers::Result* came = nullptr;  ///< null: comers were not searched for
  };

  RadialMovers(const Intrinsics& camera, const ComerParameters& comers,
               const CircleParameters& circle, const EdgeParameters& edge)
      : camera_(camera),
        circle_(circle),
        comers_(camera, comers, circle, edge),
        goers_(camera, circle, edge) {}

  /// \param corners_px,reasons of the frame, in the caller's order.
  /// \param view null: comers are not searched for.
  /// \return valid until the next call. Nothing is found without a ground, or while the camera
  ///   stands still or looks straight down.
  Result step(const BothKinds<Edge>& edges, const CircleExpert::Result& circles,
              std::span<const Eigen::Vector2f> corners_px, std::span<const Reason> reasons,
              const MotionField& field, GapView* view);

  /// Drops what is known of earlier frames.
  void forget() { comers_.forget(); }

 private:
  Intrinsics camera_;
  CircleParameters circle_;
  Comers comers_;
  Goers goers_;
  Relabel relabel_;
  std::vector<GroundEdge> seen_;
  std::vector<double> odds_;
  std::vector<int> joined_;
};

}  // namespace lcs
