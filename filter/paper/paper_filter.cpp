#include "filter/paper/paper_filter.h"

#include <optional>

#include "filter/edges/edge.h"
#include "filter/ego_motion/intake.h"
#include "filter/matching/refill.h"
#include "filter/paper/feedback.h"
#include "filter/paper/paper_circles.h"
#include "filter/paper/paper_edges.h"
#include "filter/paper/paper_squares.h"
#include "filter/stopwatch.h"

namespace lcs::paper {

struct PaperFilter::Impl {
  Impl(const Intrinsics& c, const PaperParameters& p)
      : camera(c),
        parameters(p),
        feedback(p.circle.trust),
        line(c, p.line),
        edge_expert(c, p.edge, p.circle.trust),
        circle_expert(c, p.circle, p.edge.corner_noise, p.ignore),
        square_expert(c, p.square, p.ignore) {
    lcs::validate(c);
    validate(p);
  }

  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& told);

  Intrinsics camera;
  PaperParameters parameters;
  Intake intake;
  Diagnostics diagnostics;
  Feedback feedback;
  LineExpert line;
  PaperEdges edge_expert;
  PaperCircles circle_expert;
  PaperSquares square_expert;

  // Of the last frame.
  EdgeLayer edges_before;
  BothKinds<Circle> circles_before;
  std::vector<Square> squares_before;

  FrameResult result;
};

namespace {

template <typename T>
void copy_both(const BothKinds<T>& from, BothKinds<T>& to) {
  copy_over(from.normal, to.normal);
  copy_over(from.rebel, to.rebel);
}

}  // namespace

const FrameResult& PaperFilter::Impl::step(std::span<const Eigen::Vector2f> corners_px,
                                           std::span<const Signature> signatures,
                                           const EgoMotion& told) {
  Stopwatch watch;
  const std::optional<EgoMotion> motion = intake.take(told, diagnostics);
  if (!motion) {
    edges_before = {};
    circles_before = {};
    squares_before = {};
  }
  const MotionField field(camera, motion.value_or(EgoMotion{}), parameters.field);
  const EdgeLayer& predicted_edges = edge_expert.predict(edges_before, field);
  const BothKinds<Circle>& predicted_circles = circle_expert.predict(circles_before, field);
  const std::vector<Square>& predicted_squares = square_expert.predict(squares_before, field);

  const auto& [psi, lambda] = feedback.regions(predicted_circles.normal, predicted_squares);
  const Chi& chi = line.collect(corners_px, signatures, psi);
  count_rejected(chi, diagnostics);
  const std::vector<int>& groups = feedback.group(lambda, chi);
  result.times.line_ms = watch.lap_ms();

  const PaperEdges::Result& edges = edge_expert.update(predicted_edges, chi, groups, psi, field);
  const PaperCircles::Result& circles =
      circle_expert.update(edges.layer.edges, predicted_circles, psi, field);
  result.times.circle_ms = watch.lap_ms();

  const std::vector<Square>& squares =
      square_expert.update(circles.circles, predicted_squares, psi, field);
  result.times.square_ms = watch.lap_ms();

  copy_both(edges.layer.edges, edges_before.edges);
  copy_over(edges.layer.chains, edges_before.chains);
  copy_both(circles.circles, circles_before);
  copy_over(squares, squares_before);

  assign_verdicts(chi, edges.verdicts, edges.reasons, result);
  Layers& layers = result.layers;
  copy_over(edges.layer.edges.normal, layers.normal_edges);
  copy_over(edges.layer.edges.rebel, layers.rebel_edges);
  set_circles(circles.of_edges.normal, layers.normal_edges);
  set_circles(circles.of_edges.rebel, layers.rebel_edges);
  copy_over(circles.circles.normal, layers.normal_circles);
  copy_over(circles.circles.rebel, layers.rebel_circles);
  copy_over(squares, layers.squares);
  copy_over(psi, layers.ignored);
  copy_over(lambda, layers.collectors);
  copy_over(edges.layer.chains, layers.chains);
  return result;
}

PaperFilter::PaperFilter(const Intrinsics& camera, const PaperParameters& parameters)
    : impl_(new Impl(camera, parameters)) {}
PaperFilter::~PaperFilter() = default;
PaperFilter::PaperFilter(PaperFilter&&) noexcept = default;
PaperFilter& PaperFilter::operator=(PaperFilter&&) noexcept = default;

const FrameResult& PaperFilter::step(std::span<const Eigen::Vector2f> corners_px,
                                     const EgoMotion& motion) {
  return impl_->step(corners_px, {}, motion);
}

const FrameResult& PaperFilter::step(std::span<const Eigen::Vector2f> corners_px,
                                     std::span<const Signature> signatures,
                                     const EgoMotion& motion) {
  lcs::validate(corners_px, signatures);
  return impl_->step(corners_px, signatures, motion);
}

const Diagnostics& PaperFilter::diagnostics() const {
  return impl_->diagnostics;
}

}  // namespace lcs::paper
