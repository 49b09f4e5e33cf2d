/// \file
/// Movers along the line of sight, which the edges alone cannot tell from static points: comers and
/// goers. Works on the edges and circles of a frame, after the circle expert.
#pragma once

#include <cmath>
#include <span>
#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/circles/circle_parameters.h"
#include "filter/edges/edge_parameters.h"
#include "filter/kinematics/motion_field.h"
#include "filter/matching/members.h"
#include "filter/matching/point_grid.h"
#include "filter/radial/comer_parameters.h"
#include "filter/types/frame_result.h"
#include "filter/types/gap.h"
#include "filter/types/layers.h"
#include "filter/types/reason.h"

namespace lcs {

/// The ground's directions in the picture, and coordinates of rays by it. Needs a ground, and a
/// camera that does not look straight down.
class GroundView {
 public:
  GroundView(const Intrinsics& camera, const MotionField& field)
      : camera_(camera),
        ground_(*field.ground()),
        across_(Vec2(-ground_.up_C.y(), ground_.up_C.x()).normalized()),
        slack_pm_(field.ground_slack() / field.reference_depth_m()) {}

  /// Fall of the ray of a place, per unit of depth.
  double down(const Vec2& x_px) const {
    return ground_.height_m * ground_.inverse_depth_pm(ray(x_px));
  }
  /// The same to the right.
  double along(const Vec2& x_px) const { return across_.dot(ray(x_px)); }
  /// 1/m: inverse depth of the ground where rays fall by `down`.
  double ground_pm(double down) const { return down / ground_.height_m; }
  /// 1/m: standard deviation of it, by the ground's tilt.
  double slack_pm() const { return slack_pm_; }
  /// `down` of the ground at this inverse depth.
  double ground_down(double inverse_depth_pm) const { return inverse_depth_pm * ground_.height_m; }
  /// Largest `down` in the picture, in its middle column.
  double lowest() const {
    return down({camera_.centre_px.x(), static_cast<double>(camera_.height_px - 1)});
  }

  /// Unit vector of the picture along the horizon.
  const Vec2& across() const { return across_; }
  /// Place of a ray, px.
  Vec2 place_px(double along, double down) const {
    const Vec2 up = ground_.up_C.head<2>();
    const double upward = -(down + ground_.up_C.z()) / up.norm();
    return camera_.centre_px + camera_.focal_px * (along * across_ + upward * up.normalized());
  }
  /// px per unit of `down`.
  double px_per_down() const { return camera_.focal_px / ground_.up_C.head<2>().norm(); }

 private:
  Vec2 ray(const Vec2& x_px) const { return (x_px - camera_.centre_px) / camera_.focal_px; }

  const Intrinsics& camera_;
  Ground ground_;
  Vec2 across_;
  double slack_pm_;
};

/// A normal edge by that view.
struct GroundEdge {
  GroundEdge(const Edge& edge, const GroundView& view, const MotionField& field,
             const CircleParameters& circle)
      : inverse_depth_pm(edge.depth_ratio / field.reference_depth_m()),
        sigma_pm(edge.depth_ratio_sigma / field.reference_depth_m()),
        down(view.down(edge.location)),
        along(view.along(edge.location)),
        is_seen(edge.corner >= 0 && std::isfinite(sigma_pm)) {
    const double ground_pm = view.ground_pm(down);
    const Eigen::Vector3d sigmas(sigma_pm, view.slack_pm(), circle.roughness * ground_pm);
    is_ground = std::abs(inverse_depth_pm - ground_pm) < 2 * sigmas.norm();
  }

  double inverse_depth_pm, sigma_pm;
  double down, along;
  bool is_seen;    ///< it has a corner in this frame, and a depth
  bool is_ground;  ///< it may be a point of the ground
};

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
