#include "filter/stages.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <iterator>
#include <stdexcept>
#include <string>

#include "filter/pixels.h"
#include "filter/refill.h"

namespace lcs {
namespace {

using Clock = std::chrono::steady_clock;

/// Of pictures: what the filter holds for every pixel must fit into memory.
constexpr int kLongestSide_px = 16384;

double ms_since(Clock::time_point start) {
  return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
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

}  // namespace

Stages::Stages(const Intrinsics& camera, const Parameters& parameters)
    : camera_(checked(camera)),
      parameters_(checked(parameters)),
      line_(camera_, static_cast<std::size_t>(parameters_.line.max_corners)),
      turn_(camera_, parameters_.field, parameters_.circle.trust),
      edges_(make_edge_expert(camera_, parameters_.circle)),
      circles_(camera_, parameters_.circle),
      squares_(camera_, parameters_.square) {}

/// Forgets all but the ids.
void Stages::start_anew(Layers& layers) {
  layers.normal_edges.clear();
  layers.rebel_edges.clear();
  layers.normal_circles.clear();
  layers.rebel_circles.clear();
  layers.squares.clear();
  layers.chains.clear();
  edges_->forget();
}

/// What the gyro did not see of the motion, the corners show.
void Stages::see_turn(Frame& frame, std::span<const Vec2> corners_px) {
  frame.motion = turn_.seen(frame.motion, frame.result.layers.normal_edges, corners_px);
  frame.field.emplace(camera_, frame.motion, parameters_.field);
}

/// Edges and circles of the frame before go to where this frame should show them.
void Stages::predict_circles(Frame& frame) {
  Layers& layers = frame.result.layers;
  edges_->predict(layers, *frame.field);
  circles_.predict(layers, *frame.field);
  layers.ignored.clear();
  layers.collectors.clear();
  circles_.feed_back(layers, layers.ignored, layers.collectors);
}

void Stages::predict_squares(Frame& frame) {
  squares_.predict(frame.result.layers, *frame.field);
}

/// Says of the corners that the Line expert did not hand on why, and counts them.
void Stages::turn_away(std::span<const Eigen::Vector2f> corners_px, Frame& frame) {
  std::vector<Reason>& reasons = frame.result.reasons;
  const Pixels picture{camera_.width_px, camera_.height_px};
  refill(reasons, corners_px.size(), Reason::too_many);
  for (std::size_t i = 0; i < corners_px.size(); ++i) {
    if (!corners_px[i].allFinite()) {
      reasons[i] = Reason::not_finite;
    } else if (!picture.contain(corners_px[i].cast<double>())) {
      reasons[i] = Reason::outside;
    }
    if (frame.result.verdicts[i] == Verdict::ignored) reasons[i] = Reason::in_psi;
  }
  for (const int source : frame.chi.sources) reasons[source] = Reason::unknown;
  for (const Chi::Repeat& repeat : frame.chi.repeats) reasons[repeat.source] = Reason::unknown;

  const auto count = [&](Fault fault, Reason reason) {
    diagnostics_.add(fault, std::count(reasons.begin(), reasons.end(), reason));
  };
  count(Fault::corner_not_finite, Reason::not_finite);
  count(Fault::corner_outside, Reason::outside);
  count(Fault::corner_too_many, Reason::too_many);
  diagnostics_.add(Fault::corner_repeated, static_cast<std::int64_t>(frame.chi.repeats.size()));
}

void Stages::line(std::span<const Eigen::Vector2f> corners_px,
                  std::span<const Signature> signatures, const EgoMotion& told, Frame& frame) {
  const auto start = Clock::now();
  const std::optional<EgoMotion> usable = intake_.take(told, diagnostics_);
  frame.is_anew = !usable;
  frame.motion = usable.value_or(EgoMotion{});
  frame.field.emplace(camera_, frame.motion, parameters_.field);
  if (frame.is_anew) start_anew(frame.result.layers);
  std::span<const IgnoreRegion> psi;
  if (feeds_back()) {
    if (is_turn_unseen(frame)) {
      finite_.clear();
      for (const Eigen::Vector2f& x : corners_px) {
        if (std::ssize(finite_) == parameters_.line.max_corners) break;
        if (x.allFinite()) finite_.push_back(x.cast<double>());
      }
      see_turn(frame, finite_);
    }
    predict_circles(frame);
    predict_squares(frame);
    squares_.feed_back(frame.result.layers, frame.result.layers.ignored);
    psi = frame.result.layers.ignored;
  }
  line_.collect(corners_px, signatures, psi, frame.chi, frame.result.verdicts);
  turn_away(corners_px, frame);
  frame.result.times.line_ms = ms_since(start);
}

void Stages::circle(Frame& frame) {
  const auto start = Clock::now();
  FrameResult& result = frame.result;
  const Chi& chi = frame.chi;
  if (!feeds_back()) {
    if (is_turn_unseen(frame)) see_turn(frame, chi.locations);
    predict_circles(frame);
  }
  grouping_.group(result.layers.collectors, frame.chi);
  edges_->update(result.layers, chi, *frame.field, result.verdicts);
  for (std::size_t c = 0; c < chi.size(); ++c) {
    result.reasons[chi.sources[c]] = edges_->reasons()[c];
  }
  for (const Chi::Repeat& repeat : chi.repeats) {
    result.verdicts[repeat.source] = result.verdicts[repeat.of_source];
    result.reasons[repeat.source] = result.reasons[repeat.of_source];
  }
  circles_.update(result.layers, *frame.field);
  if (feeds_back()) circles_.update_ignorance(result.layers);  // transition II
  result.times.circle_ms = ms_since(start);
}

void Stages::square(Frame& frame) {
  const auto start = Clock::now();
  if (!feeds_back()) predict_squares(frame);
  squares_.update(frame.result.layers, *frame.field, edges_->followers());  // transition III
  if (feeds_back()) squares_.update_ignorance(frame.result.layers);         // transition IV
  frame.result.times.square_ms = ms_since(start);
}

}  // namespace lcs
