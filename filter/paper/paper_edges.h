/// \file
/// The paper's edges: corners are matched to predicted edges and classified (xi_1 to xi_5, zeta_r).
/// Unmatched corners go to alpha or become new normal edges.
#pragma once

#include <span>
#include <vector>

#include "filter/kinematics/motion_field.h"
#include "filter/line/line.h"
#include "filter/matching/couples.h"
#include "filter/matching/point_grid.h"
#include "filter/paper/parameters.h"
#include "filter/types/frame_result.h"

namespace lcs::paper {

/// Relation of a corner to a predicted normal edge: inside the span delta_v about its motion, at a
/// speed possible for a static point, inside its radius mu, at the prediction or short of it. The
/// paper's five cases overlap as printed. Tested in this order, exactly one holds.
enum class Xi {
  one,    ///< in the span, plausible, outside mu: a further normal edge of the layer
  two,    ///< in the span, plausible, inside mu, at or beyond the prediction: raises trust
  three,  ///< the same, but short of the prediction: lowers trust
  four,   ///< in the span, but against the field or too fast for it: to alpha
  five,   ///< outside the span: to alpha
};

/// Edges and alpha.
struct EdgeLayer {
  BothKinds<Edge> edges;
  std::vector<Chain> chains;
};

class PaperEdges {
 public:
  PaperEdges(const Intrinsics& camera, const PaperEdgeParameters& parameters,
             const TrustRanks& trust)
      : camera_(camera), parameters_(parameters), trust_(trust) {}

  struct Result {
    std::vector<Verdict> verdicts;  ///< of each corner of chi
    std::vector<Reason> reasons;    ///< of each corner of chi
  };

  /// Predicts edges and chains of the last frame to this one.
  static void predict(EdgeLayer& layer, const MotionField& field);

  /// Matches, estimates, updates trust, deletes and creates predicted edges.
  /// \param groups index of the collector of each corner of chi, -1: none (`Feedback`).
  /// \return valid until the next call.
  const Result& update(EdgeLayer& layer, const Chi& chi, std::span<const int> groups,
                       std::span<const IgnoreRegion> psi, const MotionField& field);

  /// The case of corner `x` for a predicted normal edge.
  Xi classify(const Edge& edge, const Vec2& x, const MotionField& field) const;

 private:
  bool in_span(const Edge& edge, const Vec2& x, const MotionField& field) const;
  bool plausible_speed(const Edge& edge, const Vec2& x, const MotionField& field) const;
  double rebel_reach(const Edge& edge, const MotionField& field) const;
  bool matches_rebel(const Edge& edge, const Vec2& x, const MotionField& field) const;
  void assign(const BothKinds<Edge>& edges, const Chi& chi, const MotionField& field);
  void came_to(int corner, Reason reason);
  void update_normal(Edge& edge, const Chi& chi, std::span<const int> groups,
                     const MotionField& field);
  void update_rebel(Edge& edge, const Vec2& x, const MotionField& field);
  double spread(const Edge& edge, const Chi& chi, std::span<const int> groups) const;
  void classify_rest(const std::vector<Edge>& normal_edges, const Chi& chi,
                     const MotionField& field);
  void complete_chains(EdgeLayer& layer, const Chi& chi, const MotionField& field);
  void branch_chains(std::vector<Chain>& chains, const Chi& chi, const MotionField& field);
  double off_field(const Vec2& from, const Vec2& to, const MotionField& field) const;
  Edge make_rebel(const Chain& chain, const Vec2& x, const MotionField& field);

  /// Accepts pairs_ cheapest first, each edge and corner once, into the two lists of matches.
  void assign_one_to_one(std::size_t edges, std::size_t corners);

  /// An edge without a corner follows its prediction. It loses trust, unless it lies in an ignored
  /// region.
  void coast(Edge& edge, std::span<const IgnoreRegion> psi) const;

  /// A normal edge at a corner, with speed V = depth_ratio * V_v.
  Edge make_normal(const Vec2& x, double depth_ratio, double mu, const MotionField& field);

  Intrinsics camera_;
  PaperEdgeParameters parameters_;
  TrustRanks trust_;
  Id next_id_ = 1;
  Result result_;

  // Scratch storage of the current frame; members, so that a frame need not allocate.
  PointGrid corner_grid_;
  /// Pairs of an edge and a corner inside its gate, with their cost. Edge indices count normal
  /// edges first; corner indices refer to chi.
  std::vector<Couple> pairs_;
  CoupleSorter sorter_;
  std::vector<int> match_of_edge_, match_of_corner_;  // -1: none
  PointGrid edge_grid_;
  std::vector<Vec2> predictions_;
  std::vector<char> to_alpha_, to_normal_;  // next step of each unmatched corner
  std::vector<Chain> grown_;
  std::vector<Neighbour> near_;
};

}  // namespace lcs::paper
