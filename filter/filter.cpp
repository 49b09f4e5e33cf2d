#include "filter/filter.h"

#include <chrono>
#include <stdexcept>

#include "filter/circle.h"
#include "filter/edge_expert.h"
#include "filter/line.h"
#include "filter/motion_field.h"
#include "filter/refill.h"
#include "filter/square.h"

namespace lcs {
namespace {

using Clock = std::chrono::steady_clock;

double lap_ms(Clock::time_point& since) {
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double, std::milli>(now - since).count();
  since = now;
  return elapsed;
}

const Intrinsics& checked(const Intrinsics& camera) {
  if (!(camera.focal_px > 0) || camera.width_px <= 0 || camera.height_px <= 0) {
    throw std::invalid_argument("the filter needs a camera with a focal length and pixels");
  }
  return camera;
}

const Parameters& checked(const Parameters& parameters) {
  validate(parameters);
  return parameters;
}

/// Those of the corners that the Line expert kept are the Circle expert's.
void gather_reasons(std::span<const Eigen::Vector2f> corners_px, const Chi& chi,
                    const std::vector<Reason>& of_chi, const std::vector<Verdict>& verdicts,
                    std::vector<Reason>& reasons) {
  refill(reasons, verdicts.size(), Reason::too_many);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (!corners_px[i].allFinite()) reasons[i] = Reason::not_finite;
    if (verdicts[i] == Verdict::ignored) reasons[i] = Reason::in_psi;
  }
  for (std::size_t c = 0; c < chi.size(); ++c) reasons[chi.sources[c]] = of_chi[c];
}

}  // namespace

struct Filter::Impl {
  Impl(const Intrinsics& camera_in, const Parameters& parameters_in)
      : camera(checked(camera_in)),
        parameters(checked(parameters_in)),
        line(camera.centre_px, static_cast<std::size_t>(parameters.line.max_corners)),
        edges(make_edge_expert(camera, parameters.circle)),
        circles(camera, parameters.circle),
        squares(camera, parameters.square) {}

  Intrinsics camera;
  Parameters parameters;
  LineExpert line;
  std::unique_ptr<EdgeExpert> edges;
  CircleExpert circles;
  SquareExpert squares;
  FrameResult result;
};

Filter::Filter(const Intrinsics& camera, const Parameters& parameters)
    : impl_(std::make_unique<Impl>(camera, parameters)) {}
Filter::~Filter() = default;
Filter::Filter(Filter&&) noexcept = default;
Filter& Filter::operator=(Filter&&) noexcept = default;

const FrameResult& Filter::step(std::span<const Eigen::Vector2f> corners_px,
                                const EgoMotion& motion) {
  Impl& f = *impl_;
  Layers& layers = f.result.layers;
  auto clock = Clock::now();

  // What the frame before left is moved to where this frame should show it.
  const MotionField field(f.camera, motion, f.parameters.field);
  f.edges->predict(layers, field);
  f.circles.predict(layers, field);
  f.squares.predict(layers, field);
  layers.ignored.clear();
  layers.collectors.clear();
  f.circles.feed_back(layers, layers.ignored, layers.collectors);
  f.squares.feed_back(layers, layers.ignored);

  // Transition I: chi, reduced and grouped, goes to the Circle expert.
  const Chi& chi = f.line.collect(corners_px, layers.ignored, layers.collectors, f.result.verdicts);
  f.result.times.line_ms = lap_ms(clock);

  f.edges->update(layers, chi, field, f.result.verdicts);
  gather_reasons(corners_px, chi, f.edges->reasons(), f.result.verdicts, f.result.reasons);
  f.circles.update(layers, field);
  if (f.parameters.line.ignore) f.circles.update_ignorance(layers);  // transition II
  f.result.times.circle_ms = lap_ms(clock);

  f.squares.update(layers, field);                                   // transition III
  if (f.parameters.line.ignore) f.squares.update_ignorance(layers);  // transition IV
  f.result.times.square_ms = lap_ms(clock);
  return f.result;
}

}  // namespace lcs
