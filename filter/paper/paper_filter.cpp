#include "filter/paper/paper_filter.h"

#include <optional>

#include "filter/ego_motion/intake.h"
#include "filter/paper/feedback.h"
#include "filter/paper/paper_circles.h"
#include "filter/paper/paper_edges.h"
#include "filter/paper/paper_squares.h"
#include "filter/set_layers.h"
#include "filter/stopwatch.h"
#include "filter/vectors/refill.h"

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
  FrameResult result;
};

const FrameResult& PaperFilter::Impl::step(std::span<const Eigen::Vector2f> corners_px,
                                           std::span<const Signature> signatures,
                                           const EgoMotion& told) {
  Stopwatch<> watch;
  const std::optional<EgoMotion> motion = intake.take(told, diagnostics);
  if (!motion) {
    edge_expert.forget();
    circle_expert.forget();
    square_expert.forget();
  }
  const MotionField field(camera, motion.value_or(EgoMotion{}), parameters.field);
  const EdgeLayer& predicted_edges = edge_expert.predict(edge_expert.last().layer, field);
  const BothKinds<Circle>& predicted_circles =
      circle_expert.predict(circle_expert.last().circles, field);
  const std::vector<Square>& predicted_squares = square_expert.predict(square_expert.last(), field);

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

  assign_verdicts(chi, edges.verdicts, edges.reasons, result);
  Layers& layers = result.layers;
  set_layers(edges.layer.edges, circles.circles, circles.of_edges, squares, layers);
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
