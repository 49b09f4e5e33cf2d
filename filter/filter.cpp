#include "filter/filter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <utility>

#include "filter/circles/circle.h"
#include "filter/edges/edge_expert.h"
#include "filter/ego_motion/intake.h"
#include "filter/kinematics/motion_field.h"
#include "filter/line/line.h"
#include "filter/matching/refill.h"
#include "filter/paper/corner_grouping.h"
#include "filter/squares/square.h"

namespace lcs {
namespace {

using Clock = std::chrono::steady_clock;

const Intrinsics& checked(const Intrinsics& camera) {
  if (!(camera.focal_px > 0) || !std::isfinite(camera.focal_px) || !camera.centre_px.allFinite() ||
      camera.width_px < 1 || camera.height_px < 1) {
    throw std::invalid_argument(
        "the filter needs a camera with a focal length, a principal point, and pixels on each side");
  }
  return camera;
}

const Parameters& checked(const Parameters& parameters) {
  validate(parameters);
  return parameters;
}

}  // namespace

/// The three experts, and what goes from one to the next and from one frame to the next.
///
/// Of the frame before, each expert goes on from what it made itself: Circle from edges and
/// circles, Square from squares. Only psi, which the Line expert starts from where regions are
/// ignored, comes from the circles and squares of the frame before (transitions II and IV).
struct Filter::Impl {
  Impl(const Intrinsics& c, const Parameters& p)
      : camera(checked(c)),
        parameters(checked(p)),
        line(camera, static_cast<std::size_t>(parameters.line.max_corners)),
        edges(make_edge_expert(camera, parameters.circle)),
        circles(camera, parameters.circle),
        squares(camera, parameters.square) {}

  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& told);
  void start_anew();
  void turn_away(std::span<const Eigen::Vector2f> corners_px);
  void hand_out_reasons();

  Intrinsics camera;
  Parameters parameters;
  Intake intake;
  Diagnostics diagnostics;
  LineExpert line;
  CornerGrouping grouping;  // the paper's rule alone
  std::unique_ptr<EdgeExpert> edges;
  CircleExpert circles;
  SquareExpert squares;
  FrameResult result;  // of the last frame, and of the one before while a step is made
  Chi chi;
};

const FrameResult& Filter::Impl::step(std::span<const Eigen::Vector2f> corners_px,
                                      std::span<const Signature> signatures,
                                      const EgoMotion& told) {
  Layers& layers = result.layers;
  auto start = Clock::now();
  const auto lap_ms = [&] {
    const auto from = std::exchange(start, Clock::now());
    return std::chrono::duration<double, std::milli>(start - from).count();
  };

  const std::optional<EgoMotion> motion = intake.take(told, diagnostics);
  if (!motion) start_anew();
  const MotionField field(camera, motion.value_or(EgoMotion{}), parameters.field);
  edges->predict(layers, field);
  circles.predict(layers, field);
  squares.predict(layers, field);
  layers.ignored.clear();
  layers.collectors.clear();
  circles.feed_back(layers, layers.ignored, layers.collectors);
  squares.feed_back(layers, layers.ignored);

  line.collect(corners_px, signatures, layers.ignored, chi, result.verdicts);
  turn_away(corners_px);
  result.times.line_ms = lap_ms();

  // Transition I: chi goes to the Circle expert.
  if (parameters.circle.edge_rule == EdgeRule::paper) grouping.group(layers.collectors, chi);
  edges->update(layers, chi, field, result.verdicts);
  if (edges->began_anew()) diagnostics.add(Fault::motion_contradicted);
  hand_out_reasons();
  circles.update(layers, field);
  if (parameters.line.ignore) circles.update_ignorance(layers);  // transition II
  result.times.circle_ms = lap_ms();

  squares.update(layers, field);                                 // transition III
  if (parameters.line.ignore) squares.update_ignorance(layers);  // transition IV
  result.times.square_ms = lap_ms();
  return result;
}

/// Forgets all but the ids.
void Filter::Impl::start_anew() {
  result.layers = {};
  edges->forget();
}

/// Says of the corners that the Line expert did not hand on why, and counts them.
void Filter::Impl::turn_away(std::span<const Eigen::Vector2f> corners_px) {
  std::vector<Reason>& reasons = result.reasons;
  const Pixels picture{camera.width_px, camera.height_px};
  refill(reasons, corners_px.size(), Reason::too_many);
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    if (!corners_px[i].allFinite()) {
      reasons[i] = Reason::not_finite;
    } else if (!picture.contain(corners_px[i].cast<double>())) {
      reasons[i] = Reason::outside;
    }
    if (result.verdicts[i] == Verdict::ignored) reasons[i] = Reason::in_psi;
  }
  for (const int source : chi.sources) reasons[source] = Reason::unknown;
  for (const Chi::Repeat& repeat : chi.repeats) reasons[repeat.source] = Reason::unknown;

  const auto count = [&](Fault fault, Reason reason) {
    diagnostics.add(fault, std::count(reasons.begin(), reasons.end(), reason));
  };
  count(Fault::corner_not_finite, Reason::not_finite);
  count(Fault::corner_outside, Reason::outside);
  count(Fault::corner_too_many, Reason::too_many);
  diagnostics.add(Fault::corner_repeated, static_cast<std::int64_t>(chi.repeats.size()));
}

void Filter::Impl::hand_out_reasons() {
  for (std::size_t c = 0; c < chi.size(); ++c) {
    result.reasons[chi.sources[c]] = edges->reasons()[c];
  }
  for (const Chi::Repeat& repeat : chi.repeats) {
    result.verdicts[repeat.source] = result.verdicts[repeat.of_source];
    result.reasons[repeat.source] = result.reasons[repeat.of_source];
  }
}

Filter::Filter(const Intrinsics& camera, const Parameters& parameters)
    : impl_(new Impl(camera, parameters)) {}
Filter::~Filter() = default;
Filter::Filter(Filter&&) noexcept = default;
Filter& Filter::operator=(Filter&&) noexcept = default;

const FrameResult& Filter::step(std::span<const Eigen::Vector2f> corners_px,
                                const EgoMotion& motion) {
  return impl_->step(corners_px, {}, motion);
}

const FrameResult& Filter::step(std::span<const Eigen::Vector2f> corners_px,
                                std::span<const Signature> signatures, const EgoMotion& motion) {
  if (signatures.size() != corners_px.size()) {
    throw std::invalid_argument("the filter was given " + std::to_string(signatures.size()) +
                                " signatures for " + std::to_string(corners_px.size()) +
                                " corners; give one for each");
  }
  return impl_->step(corners_px, signatures, motion);
}

const Diagnostics& Filter::diagnostics() const {
  return impl_->diagnostics;
}

}  // namespace lcs
