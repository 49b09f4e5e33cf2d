/// \file
/// The paper's edges (`filter/paper/paper_edges.h`), in which rules of the default filter replace
/// the paper's one at a time: depth, gate, signatures, and rebels by two sightings. Without any of
/// them it gives the same bits as `PaperEdges`.
#pragma once

#include <optional>
#include <span>
#include <unordered_map>
#include <vector>

#include "filter/edges/coupling.h"
#include "filter/edges/edge_parameters.h"
#include "filter/edges/neighbourhood.h"
#include "filter/paper/paper_edges.h"
#include "tests/study/rules.h"

namespace lcs::study {

class StepEdges {
 public:
  /// \param ours the numbers of the rules that are the default filter's.
  StepEdges(const Intrinsics& camera, const paper::PaperEdgeParameters& parameters,
            const EdgeParameters& ours, const TrustRanks& trust, const Rules& rules)
      : camera_(camera),
        parameters_(parameters),
        ours_(ours),
        trust_(trust),
        rules_(rules),
        coupling_(ours) {}

  /// Predicts edges and rows of the last frame to this one.
  void predict(paper::EdgeLayer& layer, const MotionField& field) const;

  /// Like `PaperEdges::update`.
  const paper::PaperEdges::Result& update(paper::EdgeLayer& layer, const Chi& chi,
                                          std::span<const int> groups,
                                          std::span<const IgnoreRegion> psi,
                                          const MotionField& field);

  /// The rule of coupling, after `update`: the kinds of the edges by the beliefs of their
  /// neighbours. Sets the verdicts of the last update anew.
  /// \return valid until the next call.
  const BothKinds<Edge>& believed(const BothKinds<Edge>& edges, const Chi& chi,
                                  const MotionField& field);

 private:
  paper::Xi classify(const Edge& edge, const Vec2& x, const MotionField& field) const;
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
  void complete_chains(paper::EdgeLayer& layer, const Chi& chi, const MotionField& field);
  void branch_chains(std::vector<Chain>& chains, const Chi& chi, const MotionField& field);
  double off_field(const Vec2& from, const Vec2& to, const MotionField& field) const;
  Edge make_rebel(const Chain& chain, const Vec2& x, const MotionField& field);
  void assign_one_to_one(std::size_t edges, std::size_t corners);
  void coast(Edge& edge, std::span<const IgnoreRegion> psi) const;
  Edge make_normal(const Vec2& x, double mu, const MotionField& field);

  // The rules of ours.
  static void advance_depth(Edge& edge, const MotionField& field);
  void see_depth(Edge& edge, double residual_px, double step_px, const MotionField& field) const;
  Vec2 variance_px2(const Edge& edge, const MotionField& field) const;
  double distance2(const Edge& edge, const Vec2& x, const MotionField& field) const;
  std::optional<double> likeness(const Signature* before, int corner, const Chi& chi) const;
  std::optional<double> likeness(Id edge, int corner, const Chi& chi) const;
  void find_seconds(const std::vector<Chain>& chains, const Chi& chi, const MotionField& field);
  void remember(const BothKinds<Edge>& edges, const Chi& chi);

  Intrinsics camera_;
  paper::PaperEdgeParameters parameters_;
  EdgeParameters ours_;
  TrustRanks trust_;
  Rules rules_;
  Id next_id_ = 1;
  paper::PaperEdges::Result result_;
  std::unordered_map<Id, Signature> look_of_edge_;
  std::vector<Signature> look_of_row_;  // of the last sighting of each row

  PointGrid corner_grid_;
  std::vector<Couple> pairs_;
  CoupleSorter sorter_;
  std::vector<int> match_of_edge_, match_of_corner_;  // -1: none
  PointGrid edge_grid_;
  std::vector<Vec2> predictions_;
  std::vector<char> to_alpha_, to_normal_;  // next step of each unmatched corner
  std::vector<Chain> grown_;
  std::vector<Signature> grown_looks_;
  std::vector<Neighbour> near_;
  Neighbourhood around_;
  Coupling coupling_;
  std::vector<Coupling::Node> nodes_;
  BothKinds<Edge> believed_;
};

}  // namespace lcs::study
