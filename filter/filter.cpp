#include "filter/filter.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "filter/circles/circle_expert.h"
#include "filter/edges/edge_expert.h"
#include "filter/edges/explanation.h"
#include "filter/ego_motion/intake.h"
#include "filter/kinematics/motion_field.h"
#include "filter/line/line.h"
#include "filter/radial/radial_movers.h"
#include "filter/set_layers.h"
#include "filter/squares/bodies.h"
#include "filter/squares/square_expert.h"
#include "filter/stopwatch.h"

namespace lcs {

struct Filter::Impl {
  Impl(const Intrinsics& c, const Parameters& p)
      : camera(c),
        parameters(p),
        line(c, p.line),
        edge_expert(c, p.edge, p.circle.trust),
        circle_expert(c, p.circle, p.edge),
        radial(c, p.comers, p.circle, p.edge),
        square_expert(c, p.square),
        bodies(c, p.edge, p.circle.trust) {
    validate(c);
    validate(p);
  }

  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& told,
                          GapView* view);
  EgoMotion last_motion_over(const EgoMotion& told) const;

  Intrinsics camera;
  Parameters parameters;
  Intake intake;
  EgoMotion last;  ///< the motion used for the last frame; without time if none was
  Diagnostics diagnostics;
  LineExpert line;
  std::span<const int> sources;  ///< the caller's index of each corner of chi, in the last frame
  EdgeExpert edge_expert;
  CircleExpert circle_expert;
  RadialMovers radial;
  SquareExpert square_expert;
  Bodies bodies;
  FrameResult result;
};

/// The motion of the last frame, over the time of the told one; without meaning if there was none.
EgoMotion Filter::Impl::last_motion_over(const EgoMotion& told) const {
  EgoMotion motion = last;
  if (!(last.dt_s > 0)) return motion;
  motion.dt_s = told.dt_s;
  Eigen::AngleAxisd turn(last.R_cur_prev);
  turn.angle() *= told.dt_s / last.dt_s;
  motion.R_cur_prev = turn.toRotationMatrix();
  motion.ground = told.ground;
  return motion;
}

const FrameResult& Filter::Impl::step(std::span<const Eigen::Vector2f> corners_px,
                                      std::span<const Signature> signatures, const EgoMotion& told,
                                      GapView* view) {
  Stopwatch<> watch;
  std::optional<EgoMotion> motion = intake.take(told, diagnostics);
  if (!motion) {
    edge_expert.forget();
    circle_expert.forget();
    radial.forget();
    bodies.forget();
    motion.emplace();
  }
  if (!parameters.ground) motion->ground.reset();
  const MotionField told_field(camera, *motion, parameters.field);

  const Chi& chi = line.collect(corners_px, signatures, {});
  count_rejected(chi, diagnostics);
  sources = chi.sources;
  result.times.line_ms = watch.lap_ms();

  const EgoMotion as_before = last_motion_over(*motion);
  std::optional<MotionField> held;
  if (last.dt_s > 0) held.emplace(camera, as_before, parameters.field);
  const EdgeExpert::Result& tracked = edge_expert.step(chi, told_field, held ? &*held : nullptr);
  if (tracked.motion != UsedMotion::told) diagnostics.add(Fault::motion_contradicted);
  const bool is_held = tracked.motion == UsedMotion::held;
  if (is_held) {
    *motion = as_before;
  } else if (tracked.motion == UsedMotion::none) {
    radial.forget();
    bodies.forget();
    motion->dt_s = 0;
  }
  const MotionField& field = is_held ? *held : told_field;
  last = *motion;
  assign_verdicts(chi, tracked.verdicts, tracked.reasons, tracked.log_odds, result);
  const BothKinds<Edge>* edges = &tracked.edges;
  const CircleExpert::Result* circles = &circle_expert.step(*edges, field);
  result.gaps.reset();
  if (view != nullptr) {
    view->begin(*motion);
    result.gaps.emplace();
  }
  const auto& [moved, came] =
      radial.step(*edges, *circles, corners_px, result.reasons, field, view);
  if (came != nullptr) *result.gaps = came->gaps;
  if (moved != nullptr) {
    edges = &moved->edges;
    circles = &moved->circles;
    assign_rebels(chi, moved->came, Reason::comer, result);
    assign_rebels(chi, moved->went, Reason::goer, result);
    if (came != nullptr) assign_rebels(chi, came->inherited, Reason::inherited, result);
  }
  result.times.circle_ms = watch.lap_ms();

  const std::vector<Square>& squares =
      bodies.step(*edges, *circles, square_expert.step(*edges, *circles, field), field);
  result.times.square_ms = watch.lap_ms();

  set_layers(*edges, *circles, squares, result.layers);
  return result;
}

Filter::Filter(const Intrinsics& camera, const Parameters& parameters)
    : impl_(new Impl(camera, parameters)) {}
Filter::~Filter() = default;
Filter::Filter(Filter&&) noexcept = default;
Filter& Filter::operator=(Filter&&) noexcept = default;

const FrameResult& Filter::step(std::span<const Eigen::Vector2f> corners_px,
                                const EgoMotion& motion, GapView* view) {
  return impl_->step(corners_px, {}, motion, view);
}

const FrameResult& Filter::step(std::span<const Eigen::Vector2f> corners_px,
                                std::span<const Signature> signatures, const EgoMotion& motion,
                                GapView* view) {
  validate(corners_px, signatures);
  return impl_->step(corners_px, signatures, motion, view);
}

std::optional<Explanation> Filter::explain(int corner) const {
  const std::span<const int> sources = impl_->sources;
  const auto found = std::ranges::find(sources, corner);
  if (found == sources.end()) return std::nullopt;
  Explanation said = impl_->edge_expert.explain(static_cast<std::size_t>(found - sources.begin()));
  for (Voice& voice : said.voices) voice.corner = sources[static_cast<std::size_t>(voice.corner)];
  return said;
}

const Diagnostics& Filter::diagnostics() const {
  return impl_->diagnostics;
}

void validate(const Intrinsics& camera) {
  if (!(camera.focal_px > 0) || !std::isfinite(camera.focal_px) || !camera.centre_px.allFinite() ||
      camera.width_px < 1 || camera.height_px < 1) {
    throw std::invalid_argument(
        "the filter needs a camera with a focal length, a principal point, and pixels on each "
        "side");
  }
}

void validate(std::span<const Eigen::Vector2f> corners_px, std::span<const Signature> signatures) {
  if (signatures.size() == corners_px.size()) return;
  throw std::invalid_argument("the filter was given " + std::to_string(signatures.size()) +
                              " signatures for " + std::to_string(corners_px.size()) +
                              " corners; give one for each");
}

}  // namespace lcs
