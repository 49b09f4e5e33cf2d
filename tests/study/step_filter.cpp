#include "tests/study/step_filter.h"

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "filter/circles/circle_expert.h"
#include "filter/edges/edge_expert.h"
#include "filter/ego_motion/intake.h"
#include "filter/line/line.h"
#include "filter/paper/paper_circles.h"
#include "filter/paper/paper_filter.h"
#include "filter/paper/paper_squares.h"
#include "filter/radial/radial_movers.h"
#include "filter/set_layers.h"
#include "filter/squares/bodies.h"
#include "filter/squares/square_expert.h"
#include "tests/study/step_edges.h"
#include "tests/study/step_tracks.h"

namespace lcs::study {
namespace {

Parameters parameters_of(const Rules& rules) {
  Parameters ours;
  if (!rules.scene) ours.edge.crossings = 0;
  return ours;
}

/// Circles and squares of the paper form from edges with the paper's ranks of trust.
const TrustRanks& trust_of(const Rules& rules, const Parameters& ours,
                           const paper::PaperParameters& papers) {
  return rules.groups ? ours.circle.trust : papers.circle.trust;
}

}  // namespace

struct StepFilter::Impl {
  Impl(const Intrinsics& c, const Rules& r)
      : camera(c),
        rules(r),
        ours(parameters_of(r)),
        line(c, ours.line),
        feedback(papers.circle.trust),
        step_edges(c, papers.edge, ours.edge, papers.circle.trust, rules),
        paper_circles(c, papers.circle, papers.edge.corner_noise, !rules.no_psi),
        paper_squares(c, papers.square, !rules.no_psi),
        step_tracks(c, ours.edge, trust_of(rules, ours, papers), rules),
        edge_expert(c, ours.edge, trust_of(rules, ours, papers)),
        circle_expert(c, ours.circle, ours.edge),
        radial(c, ours.comers, ours.circle, ours.edge),
        square_expert(c, ours.square),
        bodies(c, ours.edge, ours.circle.trust) {
    lcs::validate(c);
  }

  void forget();
  void step_of_paper(std::span<const Eigen::Vector2f> corners_px,
                     std::span<const Signature> signatures, const MotionField& field);
  void step_of_ours(std::span<const Eigen::Vector2f> corners_px,
                    std::span<const Signature> signatures, EgoMotion motion, GapView* view);
  const EdgeExpert::Result& corrected(const Chi& chi, const MotionField& told, EgoMotion& motion,
                                      std::optional<MotionField>& held);
  void group_by_paper(const BothKinds<Edge>& edges, const MotionField& field);
  void group(const Chi& chi, std::span<const Eigen::Vector2f> corners_px,
             const BothKinds<Edge>& edges, const EgoMotion& motion, const MotionField& field,
             GapView* view);

  Intrinsics camera;
  Rules rules;
  Parameters ours;
  paper::PaperParameters papers;
  Intake intake;
  Diagnostics diagnostics;
  LineExpert line;
  // The paper's rules, and their state.
  paper::Feedback feedback;
  StepEdges step_edges;
  paper::PaperCircles paper_circles;
  paper::PaperSquares paper_squares;
  paper::EdgeLayer layer;
  CircleExpert::Result circles_of_paper;
  std::vector<Square> squares_of_paper;
  // Ours.
  StepTracks step_tracks;
  EdgeExpert edge_expert;
  EgoMotion last;
  CircleExpert circle_expert;
  RadialMovers radial;
  SquareExpert square_expert;
  Bodies bodies;
  FrameResult result;
};

void StepFilter::Impl::forget() {
  layer = {};
  circles_of_paper = {};
  squares_of_paper.clear();
  step_tracks.forget();
  edge_expert.forget();
  circle_expert.forget();
  radial.forget();
  bodies.forget();
}

/// A frame with the paper's edges, like `PaperFilter::step`.
void StepFilter::Impl::step_of_paper(std::span<const Eigen::Vector2f> corners_px,
                                     std::span<const Signature> signatures,
                                     const MotionField& field) {
  step_edges.predict(layer, field);
  paper::PaperCircles::predict(circles_of_paper.circles, field);
  paper::PaperSquares::predict(squares_of_paper, field);
  auto& [psi, lambda, alpha] = result.paper;
  feedback.set_regions(circles_of_paper.circles.normal, squares_of_paper, result.paper);
  const Chi& chi = line.collect(corners_px, signatures, psi);
  const std::vector<int>& groups = feedback.group(lambda, chi);
  const auto& [verdicts, reasons] = step_edges.update(layer, chi, groups, psi, field);
  const BothKinds<Edge>& edges =
      rules.coupling ? step_edges.believed(layer.edges, chi, field) : layer.edges;
  paper_circles.update(edges, psi, field, circles_of_paper);
  paper_squares.update(circles_of_paper.circles, psi, field, squares_of_paper);
  assign_verdicts(chi, verdicts, reasons, {}, result);
  set_layers(edges, circles_of_paper, squares_of_paper, result.layers);
  alpha = layer.chains;
}

/// The edges by the corrected motion, as in `Filter::step`.
/// \param motion receives the motion that was used. \param held its field, if it is the last one's.
const EdgeExpert::Result& StepFilter::Impl::corrected(const Chi& chi, const MotionField& told,
                                                      EgoMotion& motion,
                                                      std::optional<MotionField>& held) {
  EgoMotion as_before = last;
  if (last.dt_s > 0) {
    Eigen::AngleAxisd turn(last.R_cur_prev);
    turn.angle() *= motion.dt_s / last.dt_s;
    as_before.R_cur_prev = turn.toRotationMatrix();
    as_before.dt_s = motion.dt_s;
    as_before.ground = motion.ground;
    held.emplace(camera, as_before, ours.field);
  }
  const EdgeExpert::Result& tracked = edge_expert.step(chi, told, held ? &*held : nullptr);
  if (tracked.motion == UsedMotion::held) {
    motion = as_before;
  } else {
    held.reset();
    if (tracked.motion == UsedMotion::none) {
      radial.forget();
      bodies.forget();
      motion.dt_s = 0;
    }
  }
  last = motion;
  return tracked;
}

/// The paper's circles and squares of edges of ours.
void StepFilter::Impl::group_by_paper(const BothKinds<Edge>& edges, const MotionField& field) {
  paper::PaperCircles::predict(circles_of_paper.circles, field);
  paper::PaperSquares::predict(squares_of_paper, field);
  paper_circles.update(edges, {}, field, circles_of_paper);
  paper_squares.update(circles_of_paper.circles, {}, field, squares_of_paper);
  set_layers(edges, circles_of_paper, squares_of_paper, result.layers);
}

/// Circles, radial movers and squares, as in `Filter::step`.
void StepFilter::Impl::group(const Chi& chi, std::span<const Eigen::Vector2f> corners_px,
                             const BothKinds<Edge>& found, const EgoMotion& motion,
                             const MotionField& field, GapView* view) {
  const BothKinds<Edge>* edges = &found;
  const CircleExpert::Result* circles = &circle_expert.step(found, field);
  if (rules.radial) {
    if (view != nullptr) view->begin(motion);
    const auto& [moved, came] =
        radial.step(*edges, *circles, corners_px, result.reasons, field, view);
    if (moved != nullptr) {
      edges = &moved->edges;
      circles = &moved->circles;
      assign_rebels(chi, moved->came, Reason::comer, result);
      assign_rebels(chi, moved->went, Reason::goer, result);
      if (came != nullptr) assign_rebels(chi, came->inherited, Reason::inherited, result);
    }
  }
  const std::vector<Square>& squares =
      bodies.step(*edges, *circles, square_expert.step(*edges, *circles, field), field);
  set_layers(*edges, *circles, squares, result.layers);
}

/// A frame with edges of ours.
void StepFilter::Impl::step_of_ours(std::span<const Eigen::Vector2f> corners_px,
                                    std::span<const Signature> signatures, EgoMotion motion,
                                    GapView* view) {
  const MotionField told(camera, motion, rules.scene ? ours.field : papers.field);
  std::optional<MotionField> held;
  const Chi& chi =
      line.collect(corners_px, rules.signatures ? signatures : decltype(signatures){}, {});
  const EdgeExpert::Result& tracked =
      rules.correction ? corrected(chi, told, motion, held) : step_tracks.step(chi, told);
  const MotionField& field = held ? *held : told;
  assign_verdicts(chi, tracked.verdicts, tracked.reasons, tracked.log_odds, result);
  if (rules.groups) {
    group(chi, corners_px, tracked.edges, motion, field, view);
  } else {
    group_by_paper(tracked.edges, field);
  }
}

const FrameResult& StepFilter::step(std::span<const Eigen::Vector2f> corners_px,
                                    std::span<const Signature> signatures, const EgoMotion& told,
                                    GapView* view) {
  validate(corners_px, signatures);
  Impl& it = *impl_;
  const std::optional<EgoMotion> usable = it.intake.take(told, it.diagnostics);
  if (!usable) it.forget();
  EgoMotion motion = usable.value_or(EgoMotion{});
  if (!it.rules.scene) motion.ground.reset();
  if (it.rules.hypotheses) {
    it.step_of_ours(corners_px, signatures, motion, view);
  } else {
    it.step_of_paper(corners_px, signatures, MotionField(it.camera, motion, it.papers.field));
  }
  return it.result;
}

StepFilter::StepFilter(const Intrinsics& camera, const Rules& rules)
    : impl_(new Impl(camera, rules)) {}
StepFilter::~StepFilter() = default;

}  // namespace lcs::study
