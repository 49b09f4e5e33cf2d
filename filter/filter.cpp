#include "filter/filter.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <stdexcept>
#include <string>

#include "filter/circle.h"
#include "filter/edge_expert.h"
#include "filter/intake.h"
#include "filter/line.h"
#include "filter/motion_field.h"
#include "filter/pixels.h"
#include "filter/refill.h"
#include "filter/square.h"

namespace lcs {
namespace {

using Clock = std::chrono::steady_clock;

/// Of pictures: what the filter holds for every pixel must fit into memory.
constexpr int kLongestSide_px = 16384;

double lap_ms(Clock::time_point& since) {
  const auto now = Clock::now();
  const double elapsed = std::chrono::duration<double, std::milli>(now - since).count();
  since = now;
  return elapsed;
}

const Intrinsics& checked(const Intrinsics& camera) {
  const auto is_size = [](int pixels) { return pixels > 0 && pixels <= kLongestSide_px; };
  if (!(camera.focal_px > 0) || !std::isfinite(camera.focal_px) || !camera.centre_px.allFinite() ||
      !is_size(camera.width_px) || !is_size(camera.height_px)) {
    throw std::invalid_argument(
        "the filter needs a camera with a focal length, a principal point, and 1 to " +
        std::to_string(kLongestSide_px) + " pixels a side");
  }
  return camera;
}

const Parameters& checked(const Parameters& parameters) {
  validate(parameters);
  return parameters;
}

/// Those of the corners that the Line expert kept are the Circle expert's.
void gather_reasons(std::span<const Eigen::Vector2f> corners_px, const Pixels& picture,
                    const Chi& chi, const std::vector<Reason>& of_chi,
                    const std::vector<Verdict>& verdicts, std::vector<Reason>& reasons) {
  refill(reasons, verdicts.size(), Reason::too_many);
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    if (!corners_px[i].allFinite()) {
      reasons[i] = Reason::not_finite;
    } else if (!picture.contain(corners_px[i].cast<double>())) {
      reasons[i] = Reason::outside;
    }
    if (verdicts[i] == Verdict::ignored) reasons[i] = Reason::in_psi;
  }
  for (std::size_t c = 0; c < chi.size(); ++c) reasons[chi.sources[c]] = of_chi[c];
}

void count_corners(const std::vector<Reason>& reasons, const Chi& chi, Diagnostics& diagnostics) {
  const auto count = [&](Fault fault, Reason reason) {
    diagnostics.add(fault, std::count(reasons.begin(), reasons.end(), reason));
  };
  count(Fault::corner_not_finite, Reason::not_finite);
  count(Fault::corner_outside, Reason::outside);
  count(Fault::corner_too_many, Reason::too_many);
  diagnostics.add(Fault::corner_repeated, static_cast<std::int64_t>(chi.repeats.size()));
}

}  // namespace

struct Filter::Impl {
  Impl(const Intrinsics& camera_in, const Parameters& parameters_in)
      : camera(checked(camera_in)),
        parameters(checked(parameters_in)),
        line(camera, static_cast<std::size_t>(parameters.line.max_corners)),
        edges(make_edge_expert(camera, parameters.circle)),
        circles(camera, parameters.circle),
        squares(camera, parameters.square) {}

  Intrinsics camera;
  Parameters parameters;
  LineExpert line;
  std::unique_ptr<EdgeExpert> edges;
  CircleExpert circles;
  SquareExpert squares;
  Intake intake;
  Diagnostics diagnostics;
  FrameResult result;

  /// Forgets all but the numbers that landmarks and layers were given.
  void start_anew() {
    result.layers.clear();
    edges->forget();
  }
};

Filter::Filter(const Intrinsics& camera, const Parameters& parameters)
    : impl_(std::make_unique<Impl>(camera, parameters)) {}
Filter::~Filter() = default;
Filter::Filter(Filter&&) noexcept = default;
Filter& Filter::operator=(Filter&&) noexcept = default;

const FrameResult& Filter::step(std::span<const Eigen::Vector2f> corners_px,
                                const EgoMotion& told) {
  Impl& f = *impl_;
  Layers& layers = f.result.layers;
  auto clock = Clock::now();

  const std::optional<EgoMotion> usable = f.intake.take(told, f.diagnostics);
  if (!usable) f.start_anew();
  const EgoMotion motion = usable.value_or(EgoMotion{});

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
  gather_reasons(corners_px, {f.camera.width_px, f.camera.height_px}, chi, f.edges->reasons(),
                 f.result.verdicts, f.result.reasons);
  for (const Chi::Repeat& repeat : chi.repeats) {
    f.result.verdicts[repeat.source] = f.result.verdicts[repeat.of_source];
    f.result.reasons[repeat.source] = f.result.reasons[repeat.of_source];
  }
  count_corners(f.result.reasons, chi, f.diagnostics);
  f.circles.update(layers, field);
  if (f.parameters.line.ignore) f.circles.update_ignorance(layers);  // transition II
  f.result.times.circle_ms = lap_ms(clock);

  f.squares.update(layers, field);                                   // transition III
  if (f.parameters.line.ignore) f.squares.update_ignorance(layers);  // transition IV
  f.result.times.square_ms = lap_ms(clock);
  return f.result;
}

const Diagnostics& Filter::diagnostics() const {
  return impl_->diagnostics;
}

}  // namespace lcs
