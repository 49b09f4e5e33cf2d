#include "filter/edges/edge_expert.h"

#include <algorithm>
#include <cmath>

#include "filter/edges/edge.h"
#include "filter/edges/gauss.h"
#include "filter/edges/step.h"
#include "filter/kinematics/geometry.h"
#include "filter/vectors/refill.h"

namespace lcs {

EdgeExpert::EdgeExpert(const Intrinsics& camera, const EdgeParameters& parameters,
                       const TrustRanks& trust)
    : camera_(camera),
      parameters_(parameters),
      trust_(trust),
      association_(parameters_),
      coupling_(parameters_),
      velocity_error_(parameters_.ego_share) {}

/// Estimates the noise of this frame's corners from static tracks of earlier frames.
void EdgeExpert::estimate_noise(double dt_s) {
  const double least2 = parameters_.noise_px * parameters_.noise_px;
  noise_.fade(1 - parameters_.turnover(dt_s));
  last_noise2_px2_ = noise2_px2_;
  noise2_px2_ = std::max(least2, noise_.variance_px2(least2, parameters_.neighbours));
}

void EdgeExpert::forget() {
  tracks_.clear();
  predicted_.clear();
  velocity_error_.forget();
  is_confirmed_ = false;
  result_.motion = UsedMotion::told;
  noise_ = {};
}

void EdgeExpert::predict_tracks(const MotionField& field) {
  predicted_.clear();
  for (const Track& track : tracks_) {
    Track& next = predicted_.emplace_back(track);
    next.place_px = field.rotated(track.place_px);
    next.since_s += field.dt_s();
    next.displacement_C_m = field.R_cur_prev() * track.displacement_C_m + field.displacement_C_m();
    if (!track.has_motion()) {
      next.as_static = StaticPoint::seen_once(next.place_px, camera_, field, next.displacement_C_m,
                                              last_noise2_px2_);
    } else {
      next.as_static = track.as_static.predicted(camera_, field, parameters_.ego_share);
      next.as_moving = track.as_moving.predicted(field, parameters_.turnover_ps);
    }
    next.corner = -1;
    ++next.age;
  }
}

/// Moves the predictions to where a corrected motion puts them. Their covariances stay.
void EdgeExpert::correct_predictions(const MotionField& field) {
  for (std::size_t t = 0; t < tracks_.size(); ++t) {
    const Track& track = tracks_[t];
    Track& next = predicted_[t];
    next.place_px = field.rotated(track.place_px);
    next.displacement_C_m = field.R_cur_prev() * track.displacement_C_m + field.displacement_C_m();
    if (!track.has_motion()) {
      next.as_static = StaticPoint::seen_once(next.place_px, camera_, field, next.displacement_C_m,
                                              last_noise2_px2_);
    } else {
      next.as_static.move(track.as_static, camera_, field);
      next.as_moving.place_px = track.as_moving.moved(field);
    }
  }
}

/// \param track -1: none.
bool EdgeExpert::has_residual(int track, bool started) const {
  return track >= 0 && (!started || predicted_[track].has_motion());
}

/// Distances of the corners from the static predictions of their tracks. Uses tracks with a motion;
/// before any track has one (`started` is false), it uses tracks seen once.
void EdgeExpert::find_residuals(const MotionField& field, const Chi& chi,
                                const std::vector<int>& track_of, bool started) {
  residuals_.clear();
  const double anywhere = 1 / association_.reach_area_px2(field.dt_s());
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (!has_residual(track_of[c], started)) continue;
    const Track& track = predicted_[track_of[c]];
    const Vec2& x = chi.locations[c];
    const StaticPoint& point = track.as_static;
    StaticPoint seen = point;
    if (!started) seen.update(x, noise2_px2_, depth_bounds(field, x));
    const Vec2 by_depth = depth_bounds(field, point.place_px).half_pm() *
                          parallax_px_m(camera_, field.displacement_C_m(), point.place_px);
    const double moves = chance(track.belief);
    const double moving = started ? track.as_moving.density(x, noise2_px2_) : anywhere;
    residuals_.push_back({point.place_px, x - point.place_px, point.spread(noise2_px2_), by_depth,
                          seen.inverse_depth_pm, seen.covariance(2, 2), 1.0 / association_.crowd(c),
                          1 - moves, moves * moving + anywhere});
  }
}

/// Measures the distances from corrected predictions.
void EdgeExpert::correct_residuals(const Chi& chi, const std::vector<int>& track_of, bool started) {
  auto residual = residuals_.begin();
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (!has_residual(track_of[c], started)) continue;
    (residual++)->off_px = chi.locations[c] - predicted_[track_of[c]].as_static.place_px;
  }
}

Track EdgeExpert::first_seen(const Chi& chi, std::size_t corner) {
  Track track;
  track.id = next_id_++;
  track.place_px = chi.locations[corner];
  if (!chi.signatures.empty()) track.signature = chi.signatures[corner];
  track.sightings = 1;
  track.corner = static_cast<int>(corner);
  return track;
}

/// Log odds of a frame later: the corner may have changed its kind.
double EdgeExpert::faded(double log_odds, double dt_s) const {
  const double kind = parameters_.kind_turnover(dt_s);
  return lcs::log_odds(chance(log_odds) * (1 - kind) + parameters_.prior * kind);
}

/// Density of a moving point's second sighting (MODEL.md (13)).
double EdgeExpert::first_step(const Track& track, const Vec2& x_px, const DepthBounds& bounds,
                              double noise2_px2) const {
  const Vec2 parallax = parallax_px_m(camera_, track.displacement_C_m, track.place_px);
  return Step(x_px - track.place_px, parallax, bounds)
      .density_of_mover(association_.reach_px(track.since_s), noise2_px2);
}

/// Updates a track by a sighting. \param chance_ppx2 `Association::chance_ppx2`.
/// \return false if neither hypothesis explains the sighting; the track is then unchanged.
bool EdgeExpert::update(Track& track, const Vec2& x_px, double chance_ppx2,
                        const MotionField& field) {
  const DepthBounds bounds = depth_bounds(field, x_px);
  const double turnover = parameters_.turnover(field.dt_s()), right = 1 - turnover;
  const double kind = parameters_.kind_turnover(field.dt_s());
  const double anywhere = turnover / association_.reach_area_px2(field.dt_s());
  // A place that is rounded to whole pixels has at least 1/12 px^2.
  const double noise2 =
      std::max(1.0 / 12, track.noise.variance_px2(noise2_px2_, parameters_.neighbours));
  // At the first step the error of the velocity is added, which its prediction omits.
  const double first2 =
      noise2 + std::pow(parameters_.ego_share * (x_px - track.place_px).norm(), 2);
  StaticPoint seen = track.as_static;
  double still = seen.update(x_px, track.has_motion() ? noise2 : first2, bounds);
  double moving = 0, before = 0;
  if (!track.has_motion()) {
    moving = first_step(track, x_px, bounds, noise2);
    before = lcs::log_odds(parameters_.prior) + parameters_.newcomer;
  } else {
    moving = track.as_moving.density(x_px, noise2);
    before = faded(track.log_odds, field.dt_s());
  }
  if (track.log_odds > 0) {
    // It may have come to rest since its last sighting, at a depth that is not known yet.
    StaticPoint rested =
        StaticPoint::seen_once(track.place_px, camera_, field, track.displacement_C_m, noise2);
    const double anew = rested.update(x_px, first2, bounds), moved = chance(track.log_odds);
    const double was_still = (1 - moved) * (1 - kind * parameters_.prior) * still;
    const double rests = moved * kind * (1 - parameters_.prior) * anew;
    still = (was_still + rests) / (1 - chance(before));
    if (rests > was_still) seen = rested;
  }
  if (track.has_motion() && right * std::max(still, moving) < anywhere) return false;
  // A wrong match has a uniform density, plus the density of corners that look as good.
  const double none = anywhere + chance_ppx2;
  const double evidence = std::log((right * moving + none) / (right * still + none));
  const double most = parameters_.most_log_odds(field.dt_s());
  track.log_odds = std::clamp(before + evidence, -most, most);
  if (!track.has_motion()) {
    track.as_moving = OwnMotion::first(track.place_px, x_px, noise2, track.since_s);
  } else {
    track.as_moving.update(x_px, noise2);
  }
  // A step of EM: miss and variance of the estimated place are noise, if the match is right.
  const double moves = chance(before + evidence);
  const double stands = (1 - moves) * right * still / (right * still + none);
  const double miss2 =
      (x_px - seen.place_px).squaredNorm() + seen.covariance.topLeftCorner<2, 2>().trace();
  noise_.add(miss2, stands);
  track.noise.fade(right);
  track.noise.add(miss2, stands);
  track.noise.add(
      (x_px - track.as_moving.place_px).squaredNorm() + 2 * track.as_moving.covariance(0, 0),
      moves * right * moving / (right * moving + none));
  track.as_static = seen;
  track.place_px = x_px;
  track.unseen = 0;
  track.since_s = 0;
  track.displacement_C_m.setZero();
  ++track.sightings;
  return true;
}

/// A track without a corner coasts for some frames on its likelier hypothesis.
void EdgeExpert::coast(const MotionField& field) {
  const Pixels picture{camera_.width_px, camera_.height_px};
  for (Track& track : predicted_) {
    if (track.corner >= 0 || track.unseen++ >= parameters_.coast) continue;
    if (track.has_motion()) {
      track.belief = track.log_odds = faded(track.belief, field.dt_s());
      track.place_px = track.belief > 0 ? track.as_moving.place_px : track.as_static.place_px;
    }
    if (picture.contain(track.place_px)) tracks_.push_back(track);
  }
}

/// The log odds of moving that a track shows to its neighbours: of its own sightings, unless it may
/// be a crossing, which moves as no point does (MODEL.md (34)).
double EdgeExpert::shown(const Track& track, const MotionField& field) const {
  // Surely static corners are not asked.
  if (!track.has_motion() || track.log_odds < -kFar) return track.log_odds;
  const double dt = field.dt_s();
  const Vec2 step_px = dt * track.as_moving.velocity_pxps;
  const Step step(step_px,
                  parallax_px_m(camera_, field.displacement_C_m(), track.place_px - step_px),
                  depth_bounds(field, track.place_px));
  const double crowd = association_.crowd(static_cast<std::size_t>(track.corner));
  const double crossing =
      parameters_.crossings / (crowd * crowd) *
      step.density_of_crossing(parameters_.slide, track.as_moving.step_variance_px2(dt)) /
      step.density_of_mover(association_.reach_px(dt), noise2_px2_);
  return -std::log(std::exp(-track.log_odds) + crossing);
}

/// Sets the beliefs of the tracks seen in this frame. A track seen once takes the belief of the
/// nearest track with a motion, or 0 (pending) if none is near.
void EdgeExpert::couple(const MotionField& field) {
  nodes_.clear();
  seen_.clear();
  const double dt = field.dt_s();
  for (Track& track : tracks_) {
    if (track.corner < 0) continue;
    seen_.push_back(&track);
    nodes_.push_back({track.place_px, shown(track, field), track.as_moving.velocity_pxps * dt,
                      track.as_moving.step_variance_px2(dt), track.has_motion()});
  }
  const std::vector<double>& beliefs = coupling_.settle(
      nodes_, around_, noise2_px2_, std::min(parameters_.coupling, parameters_.most_log_odds(dt)));
  for (std::size_t i = 0; i < seen_.size(); ++i) seen_[i]->belief = beliefs[i];
}

Edge EdgeExpert::edge_of(const Track& track, const MotionField& field) const {
  Edge edge;
  edge.id = track.id;
  edge.rebel = track.belief > 0;
  edge.location = track.place_px;
  edge.predicted = edge.rebel ? track.as_moving.place_px : track.as_static.place_px;
  edge.depth_ratio = track.as_static.inverse_depth_pm * field.reference_depth_m();
  edge.age = track.age;
  edge.corner = track.corner;
  edge.trust = trust_.of_certainty(track.belief) - track.unseen;
  if (edge.rebel) {
    const Vec2& velocity_pxps = track.as_moving.velocity_pxps;
    edge.speed = velocity_pxps.norm();
    if (edge.speed > 0) edge.angle = angle_of(velocity_pxps);
    edge.origin = edge.location - field.dt_s() * velocity_pxps;  // so that beta is current
    return edge;
  }
  move_as_static(edge, camera_, field);
  edge.depth_ratio_sigma = std::sqrt(track.as_static.covariance(2, 2)) * field.reference_depth_m();
  return edge;
}

void EdgeExpert::decide(const Chi& chi, const MotionField& field) {
  auto& [edges, verdicts, reasons, motion] = result_;
  edges.normal.clear();
  edges.rebel.clear();
  refill(verdicts, chi.size(), Verdict::pending);
  refill(reasons, chi.size(), Reason::unknown);
  for (const Track& track : tracks_) {
    const bool rebel = track.belief > 0;
    if (track.corner >= 0) {
      const auto c = static_cast<std::size_t>(track.corner);
      const bool by_itself = (track.log_odds > 0) == rebel;
      if (rebel) {
        verdicts[c] = Verdict::rebel;
        reasons[c] = !track.has_motion() ? Reason::inherited
                     : by_itself         ? Reason::rebel_edge
                                         : Reason::rebel_neighbours;
      } else if (track.has_motion()) {
        verdicts[c] = Verdict::normal;
        reasons[c] = by_itself ? Reason::normal_edge : Reason::normal_neighbours;
      } else {
        reasons[c] = Reason::first_sighting;
      }
    }
    if (!track.has_motion()) continue;
    Edge edge = edge_of(track, field);
    if (edge.corner >= 0) edge.corner = chi.sources[edge.corner];
    (rebel ? edges.rebel : edges.normal).push_back(edge);
  }
  for (std::vector<Edge>* kind : {&edges.normal, &edges.rebel}) {
    delete_lost(*kind, camera_, trust_);
    std::ranges::sort(*kind, {}, &Edge::id);
  }
}

/// Predicts the tracks and assigns the corners to them. \return the track of each corner.
const std::vector<int>& EdgeExpert::follow(const MotionField& field, const Chi& chi) {
  velocity_error_.advance(field, 1 - parameters_.turnover(field.dt_s()));
  predict_tracks(velocity_error_.without(field));
  return association_.match(chi, around_, predicted_, noise2_px2_, field.dt_s());
}

/// Whether the camera rather goes on as in the last frame than moves as predicted: of the static
/// tracks that tell the two motions apart, most are nearer to where the last motion puts them.
bool EdgeExpert::is_held(const MotionField& held, const Chi& chi,
                         const std::vector<int>& track_of) const {
  const MotionField field = velocity_error_.without(held);
  int count = 0;
  double all = 0, nearer = 0;
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (track_of[c] < 0) continue;
    const Track& before = tracks_[track_of[c]];
    if (!before.has_motion()) continue;
    const StaticPoint& told = predicted_[track_of[c]].as_static;
    StaticPoint other;
    other.move(before.as_static, camera_, field);
    // Most tracks do not tell the motions apart, as the told prediction alone is uncertain enough.
    Eigen::Matrix2d S = told.spread(noise2_px2_);
    const Vec2 apart_px = told.place_px - other.place_px;
    if (!(distance2(apart_px, S) > kFar * kFar)) continue;
    other = before.as_static.predicted(camera_, field, parameters_.ego_share);
    S += other.spread(noise2_px2_);
    if (!(distance2(apart_px, S) > kFar * kFar)) continue;
    const Vec2& x = chi.locations[c];
    const double voice = (1 - chance(before.belief)) / association_.crowd(c);
    ++count;
    all += voice;
    if (distance2(x - other.place_px, S) < distance2(x - told.place_px, S)) nearer += voice;
  }
  return count >= parameters_.neighbours && nearer > 0.5 * all;
}

/// Whether the first motion, by which all depths are known, was wrong: the camera's velocity
/// differs from it, more tracks leave their predictions than move or jump to other corners, and
/// most of these would be static had they been seen in the last frame only.
/// \param first the first motion, over the same time as `told`.
bool EdgeExpert::is_first_wrong(const MotionField& told, const MotionField& first, const Chi& chi,
                                const std::vector<int>& track_of) const {
  const double most_m = std::max(told.displacement_C_m().norm(), first.displacement_C_m().norm());
  const double sigma_m =
      std::hypot(parameters_.ego_share * most_m, told.velocity_sigma_mps() * told.dt_s());
  const Eigen::Vector3d change_m = told.displacement_C_m() - first.displacement_C_m();
  if (!(change_m.norm() > kFar * sigma_m)) return false;
  double all = 0, leave = 0, stand = 0;
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (track_of[c] < 0) continue;
    const Track& track = predicted_[track_of[c]];
    if (!track.has_motion()) continue;
    const Vec2& x = chi.locations[c];
    const double voice = 1.0 / association_.crowd(c);
    all += voice;
    const StaticPoint& point = track.as_static;
    if (!(distance2(x - point.place_px, point.spread(noise2_px2_)) > kFar * kFar)) continue;
    leave += voice;
    const DepthBounds bounds = depth_bounds(told, x);
    const Vec2 parallax = parallax_px_m(camera_, told.displacement_C_m(), track.place_px);
    const double off_px = distance_to_segment(x - track.place_px, bounds.least_pm * parallax,
                                              bounds.most_pm * parallax);
    if (off_px * off_px < kFar * kFar * 2 * noise2_px2_) stand += voice;
  }
  const double usual = parameters_.prior + parameters_.turnover(told.dt_s());
  return leave > usual * all && stand > 0.5 * leave;
}

/// Whether nearly all corners would move by themselves. The camera's motion is then wrong; once all
/// tracks are rebels, none is left to correct it.
bool EdgeExpert::do_all_move() const {
  int count = 0;
  double all = 0, move = 0;
  for (const Track& track : tracks_) {
    if (track.corner < 0 || !track.has_motion()) continue;
    const double voice = 1.0 / association_.crowd(static_cast<std::size_t>(track.corner));
    ++count;
    all += voice;
    move += voice * chance(track.belief);
  }
  return count >= parameters_.neighbours && move > kLeave * all;
}

const EdgeExpert::Result& EdgeExpert::step(const Chi& chi, const MotionField& told,
                                           const MotionField* held) {
  const bool is_after_none = result_.motion == UsedMotion::none;
  if (!(told.dt_s() > 0)) forget();
  around_.build(chi.locations, parameters_.neighbour_reach_px, parameters_.neighbours);
  estimate_noise(told.dt_s());
  const VelocityError before = velocity_error_;
  const bool started = std::ranges::any_of(tracks_, &Track::has_motion);
  const MotionField* given = &told;
  UsedMotion motion = UsedMotion::told;
  const std::vector<int>* track_of = &follow(told, chi);
  if (started && held != nullptr && is_held(*held, chi, *track_of)) {
    motion = is_confirmed_ ? UsedMotion::held : UsedMotion::none;
    velocity_error_ = before;
    given = held;
    track_of = &follow(*held, chi);
  }
  const bool is_first_tested = started && !is_confirmed_ && held != nullptr;
  if (is_first_tested && is_first_wrong(told, *held, chi, *track_of)) motion = UsedMotion::none;
  MotionField field = velocity_error_.without(*given);
  if (!predicted_.empty() && motion != UsedMotion::none) {
    find_residuals(field, chi, *track_of, started);
    const MotionFix off =
        motion_finder_.find(camera_, field, residuals_, velocity_error_.covariance());
    field = field.corrected(off.turn_rad, velocity_error_.update(off));
    correct_predictions(field);
    // In the second frame no depth is known that could contradict the motion. It is checked only if
    // the motion of the last frame was contradicted.
    if (started || is_after_none) {
      correct_residuals(chi, *track_of, started);
      if (is_contradicted(residuals_)) motion = UsedMotion::none;
    }
  }
  const bool is_wrong = motion == UsedMotion::none;
  if (is_wrong) {
    forget();
  } else if (started) {
    is_confirmed_ = true;
  }
  result_.motion = motion;
  tracks_.clear();
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if ((*track_of)[c] >= 0 && !is_wrong) {
      Track& track = predicted_[(*track_of)[c]];
      track.corner = static_cast<int>(c);
      if (update(track, chi.locations[c], association_.chance_ppx2(c), field)) {
        if (!chi.signatures.empty()) track.signature = chi.signatures[c];
        tracks_.push_back(track);
        continue;
      }
    }
    tracks_.push_back(first_seen(chi, c));
  }
  if (field.dt_s() > 0) coast(field);
  couple(field);
  if (do_all_move()) {
    forget();
    result_.motion = UsedMotion::none;
    tracks_.clear();
    for (std::size_t c = 0; c < chi.size(); ++c) tracks_.push_back(first_seen(chi, c));
  }
  decide(chi, field);
  return result_;
}

}  // namespace lcs
