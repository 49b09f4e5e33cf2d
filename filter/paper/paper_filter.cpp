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
  EdgeLayer edges;
  CircleExpert::Result circles;
  std::vector<Square> squares;
  FrameResult result;
};

const FrameResult& PaperFilter::Impl::step(std::span<const Eigen::Vector2f> corners_px,
                                           std::span<const Signature> signatures,
                                           const EgoMotion& told) {
  Stopwatch<> watch;
  const std::optional<EgoMotion> motion = intake.take(told, diagnostics);
  if (!motion) {
    edges = {};
    circles = {};
    squares.clear();
  }
  const MotionField field(camera, motion.value_or(EgoMotion{}), parameters.field);
  PaperEdges::predict(edges, field);
  PaperCircles::predict(circles.circles, field);
  PaperSquares::predict(squares, field);

  auto& [psi, lambda, alpha] = result.paper;
  feedback.set_regions(circles.circles.normal, squares, result.paper);
  const Chi& chi = line.collect(corners_px, signatures, psi);
  count_rejected(chi, diagnostics);
  const std::vector<int>& groups = feedback.group(lambda, chi);
  result.times.line_ms = watch.lap_ms();

  const auto& [verdicts, reasons] = edge_expert.update(edges, chi, groups, psi, field);
  circle_expert.update(edges.edges, psi, field, circles);
  result.times.circle_ms = watch.lap_ms();

  square_expert.update(circles.circles, psi, field, squares);
  result.times.square_ms = watch.lap_ms();

  assign_verdicts(chi, verdicts, reasons, {}, result);
  set_layers(edges.edges, circles, squares, result.layers);
  copy_over(edges.chains, alpha);
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
