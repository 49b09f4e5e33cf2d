#include "filter/edges/edge_expert.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "filter/edges/explanation.h"
#include "filter/edges/gauss.h"
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

namespace {

/// (1): places after the field's rotation.
void rotate(const MotionField& field, const float* x_px, const float* y_px, std::size_t count,
            float* to_x_px, float* to_y_px) {
  if (const std::optional<Eigen::Matrix3d> exact = field.homography()) {
    const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> homography = exact->cast<float>();
    return track_loops().rotate(homography.data(), x_px, y_px, count, to_x_px, to_y_px);
  }
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2f to_px = field.rotated({x_px[i], y_px[i]}).cast<float>();
    to_x_px[i] = to_px.x();
    to_y_px[i] = to_px.y();
  }
}

}  // namespace

/// Puts the corners' places into columns.
void EdgeExpert::take(const Chi& chi) {
  corners_ = chi.size();
  refill_column(x_px_, corners_);
  refill_column(y_px_, corners_);
  for (std::size_t c = 0; c < corners_; ++c) {
    x_px_[c] = static_cast<float>(chi.locations[c].x());
    y_px_[c] = static_cast<float>(chi.locations[c].y());
  }
}

/// Estimates the noise of this frame's corners from static tracks of earlier frames.
void EdgeExpert::estimate_noise(double dt_s) {
  const double least2 = parameters_.noise_px * parameters_.noise_px;
  noise_.fade(1 - parameters_.turnover(dt_s));
  last_noise2_px2_ = noise2_px2_;
  noise2_px2_ = std::max(least2, noise_.variance_px2(least2, parameters_.neighbours));
}

void EdgeExpert::forget() {
  tracks_.records.clear();
  predicted_.records.clear();
  velocity_error_.forget();
  is_confirmed_ = false;
  result_.motion = UsedMotion::told;
  noise_ = {};
}

TrackFrame EdgeExpert::frame_of(const MotionField& field) const {
  TrackFrame frame = track_frame(camera_, field, parameters_);
  frame.noise2_px2 = static_cast<float>(noise2_px2_);
  frame.last_noise2_px2 = static_cast<float>(last_noise2_px2_);
  return frame;
}

/// Predicts the state of the tracks to this frame.
void EdgeExpert::predict(const MotionField& field, const TrackFrame& frame,
                         Tracks& predicted) const {
  const std::size_t count = tracks_.size();
  predicted.columns.make(count);
  for (const TrackColumn x : {kPlaceX, kStaticX, kMovingX}) {
    rotate(field, tracks_.columns[x], tracks_.columns[x + 1], count, predicted.columns[x],
           predicted.columns[x + 1]);
  }
  track_loops().predict(frame, tracks_.columns.data(), count, predicted.columns.data());
}

Sightings EdgeExpert::sightings() const {
  return {x_px_.data(), y_px_.data(), track_of_.data(), association_.chance_ppx2(),
          association_.crowd()};
}

/// Predicts the tracks and assigns the corners to them.
void EdgeExpert::follow(const MotionField& told, const Chi& chi) {
  velocity_error_.advance(told, 1 - parameters_.turnover(told.dt_s()));
  const MotionField field = velocity_error_.without(told);
  const TrackFrame frame = frame_of(field);
  predict(field, frame, predicted_);
  copy_over(tracks_.records, predicted_.records);
  for (Tracks::Record& record : predicted_.records) {
    record.corner = -1;
    ++record.age;
  }
  copy_over(association_.match(chi, around_, predicted_, frame), track_of_);
}

/// Whether the camera rather goes on as in the last frame than moves as predicted: of the static
/// tracks that tell the two motions apart, most are nearer to where the last motion puts them.
bool EdgeExpert::is_held(const MotionField& held) {
  const MotionField field = velocity_error_.without(held);
  predict(field, frame_of(field), other_);
  int count = 0;
  double all = 0, nearer = 0;
  for (std::size_t c = 0; c < corners_; ++c) {
    if (track_of_[c] < 0) continue;
    const auto t = static_cast<std::size_t>(track_of_[c]);
    if (!predicted_.has_motion(t)) continue;
    const Vec2 told_px = predicted_.point(kStaticX, t), held_px = other_.point(kStaticX, t);
    // Most tracks do not tell the motions apart, as the told prediction alone is uncertain enough.
    Eigen::Matrix2d S = predicted_.static_spread(t, noise2_px2_);
    const Vec2 apart_px = told_px - held_px;
    if (!(distance2(apart_px, S) > kFar * kFar)) continue;
    S += other_.static_spread(t, noise2_px2_);
    if (!(distance2(apart_px, S) > kFar * kFar)) continue;
    const Vec2 x(x_px_[c], y_px_[c]);
    const double voice = (1 - chance(predicted_.at(kBelief, t))) / association_.crowd()[c];
    ++count;
    all += voice;
    if (distance2(x - held_px, S) < distance2(x - told_px, S)) nearer += voice;
  }
  return count >= parameters_.neighbours && nearer > 0.5 * all;
}

/// Whether the first motion, by which all depths are known, was wrong: the camera's velocity
/// differs from it, more tracks leave their predictions than move or jump to other corners, and
/// most of these would be static had they been seen in the last frame only.
/// \param first the first motion, over the same time as `told`.
bool EdgeExpert::is_first_wrong(const MotionField& told, const MotionField& first) {
  const double most_m = std::max(told.displacement_C_m().norm(), first.displacement_C_m().norm());
  const double sigma_m =
      std::hypot(parameters_.ego_share * most_m, told.velocity_sigma_mps() * told.dt_s());
  const Eigen::Vector3d change_m = told.displacement_C_m() - first.displacement_C_m();
  if (!(change_m.norm() > kFar * sigma_m)) return false;
  refill_column(off2_px2_, corners_);
  track_loops().off_segment(frame_of(told), predicted_.columns.data(), sightings(), corners_,
                            off2_px2_.data());
  double all = 0, leave = 0, stand = 0;
  for (std::size_t c = 0; c < corners_; ++c) {
    if (track_of_[c] < 0) continue;
    const auto t = static_cast<std::size_t>(track_of_[c]);
    if (!predicted_.has_motion(t)) continue;
    const double voice = 1.0 / association_.crowd()[c];
    all += voice;
    const Vec2 off_px = Vec2(x_px_[c], y_px_[c]) - predicted_.point(kStaticX, t);
    if (!(distance2(off_px, predicted_.static_spread(t, noise2_px2_)) > kFar * kFar)) continue;
    leave += voice;
    if (off2_px2_[c] < kFar * kFar * 2 * noise2_px2_) stand += voice;
  }
  const double usual = parameters_.prior + parameters_.turnover(told.dt_s());
  return leave > usual * all && stand > 0.5 * leave;
}

/// Corrects the motion by the misses of the corners' static predictions, and predicts anew by it.
/// \param started whether only tracks with a motion count.
MotionField EdgeExpert::corrected(const MotionField& field, bool started) {
  asked_.clear();
  for (std::size_t c = 0; c < corners_; ++c) {
    if (track_of_[c] < 0) continue;
    if (started && !predicted_.has_motion(static_cast<std::size_t>(track_of_[c]))) continue;
    asked_.push_back(static_cast<int>(c));
  }
  const std::size_t count = asked_.size();
  asked_.resize(count + kLanes);
  misses_.make(count);
  const auto variance_m2ps2 = static_cast<float>(velocity_error_.covariance().trace() / 3);
  track_loops().misses(frame_of(field), predicted_.columns.data(), sightings(), asked_.data(),
                       count, started, variance_m2ps2, misses_.data());
  const MotionFix off =
      find_motion_fix(camera_, field, misses_.data(), count, velocity_error_.covariance());
  const MotionField right = field.corrected(off.turn_rad, velocity_error_.update(off));
  predict(right, frame_of(right), predicted_);
  asked_.resize(count);
  for (std::size_t i = 0; i < count; ++i) {
    const int c = asked_[i];
    const auto t = static_cast<std::size_t>(track_of_[c]);
    misses_[kOffX][i] = x_px_[c] - predicted_.columns[kStaticX][t];
    misses_[kOffY][i] = y_px_[c] - predicted_.columns[kStaticY][t];
  }
  return right;
}

/// Updates the tracks by their sightings. Corners without a track start one.
void EdgeExpert::see(const MotionField& field, const Chi& chi) {
  tracks_.columns.make(corners_ + predicted_.size());
  refill(tracks_.records, corners_);
  refill_column(kept_, corners_);
  const Misses misses = track_loops().see(frame_of(field), predicted_.columns.data(), sightings(),
                                          corners_, tracks_.columns.data(), kept_.data());
  noise_.add(misses.sum_px2, misses.weight);
  for (std::size_t c = 0; c < corners_; ++c) {
    Tracks::Record& record = tracks_.records[c];
    if (track_of_[c] >= 0) {
      // A track that its sighting contradicts does not coast, either.
      record = predicted_.records[static_cast<std::size_t>(track_of_[c])];
      predicted_.records[static_cast<std::size_t>(track_of_[c])].corner = static_cast<int>(c);
    }
    if (kept_[c] == 0) record = {.id = next_id_++};
    record.corner = static_cast<int>(c);
    record.unseen = 0;
    if (!chi.signatures.empty()) record.signature = chi.signatures[c];
  }
}

/// A track without a corner coasts for some frames on its likelier hypothesis.
void EdgeExpert::coast(const MotionField& field) {
  const Pixels picture{camera_.width_px, camera_.height_px};
  const double kind = parameters_.kind_turnover(field.dt_s());
  make_room(tracks_.records, corners_ + predicted_.size());
  for (std::size_t t = 0; t < predicted_.size(); ++t) {
    Tracks::Record& record = predicted_.records[t];
    if (record.corner >= 0 || record.unseen++ >= parameters_.coast) continue;
    if (predicted_.has_motion(t)) {
      const double moves = chance(predicted_.at(kBelief, t));
      const auto faded =
          static_cast<float>(log_odds(moves * (1 - kind) + parameters_.prior * kind));
      predicted_.columns[kBelief][t] = predicted_.columns[kLogOdds][t] = faded;
      const Vec2 place_px = predicted_.point(faded > 0 ? kMovingX : kStaticX, t);
      predicted_.columns[kPlaceX][t] = static_cast<float>(place_px.x());
      predicted_.columns[kPlaceY][t] = static_cast<float>(place_px.y());
    }
    if (picture.contain(predicted_.point(kPlaceX, t))) tracks_.append(predicted_, t);
  }
}

/// Sets the beliefs of the tracks seen in this frame. A track seen once takes the belief of the
/// nearest track with a motion, or 0 (pending) if none is near.
void EdgeExpert::couple(const MotionField& field) {
  const double dt = field.dt_s();
  nodes_.clear();
  refill_column(shown_, corners_);
  track_loops().show(frame_of(field), tracks_.columns.data(), association_.crowd(), corners_,
                     shown_.data());
  for (std::size_t c = 0; c < corners_; ++c) {
    nodes_.push_back({tracks_.point(kPlaceX, c), double{shown_[c]},
                      tracks_.point(kVelocityX, c) * dt, tracks_.at(kMovingVv, c) * dt * dt,
                      tracks_.has_motion(c)});
  }
  const std::vector<double>& beliefs = coupling_.settle(
      nodes_, around_, noise2_px2_, std::min(parameters_.coupling, parameters_.most_log_odds(dt)));
  for (std::size_t c = 0; c < corners_; ++c) {
    tracks_.columns[kBelief][c] = static_cast<float>(beliefs[c]);
  }
}

/// Makes the edges of a kind, by rising id: of tracks with a motion that are trusted, in the
/// picture.
void EdgeExpert::make_edges(const Chi& chi, const MotionField& field) {
  const std::size_t count = tracks_.size();
  refill_column(speed_pxps_, count);
  refill_column(angle_, count);
  refill_column(sure_, count);
  track_loops().image_motion(frame_of(field), tracks_.columns.data(), count, field.moving(),
                             speed_pxps_.data(), angle_.data());
  loops().half_tanh(tracks_.columns[kBelief], sure_.data(), count);
  const Pixels picture{camera_.width_px, camera_.height_px};
  order_.clear();
  make_room(order_, count);
  for (std::size_t t = 0; t < count; ++t) {
    if (tracks_.has_motion(t)) order_.emplace_back(tracks_.records[t].id, t);
  }
  std::ranges::sort(order_);
  const double reference_m = field.reference_depth_m();
  for (std::vector<Edge>* kind : {&result_.edges.normal, &result_.edges.rebel}) {
    kind->clear();
    make_room(*kind, count);
  }
  for (const auto& [id, t] : order_) {
    const Tracks::Record& record = tracks_.records[t];
    const int trust = trust_.of_certainty(std::abs(double{sure_[t]})) - record.unseen;
    const Vec2 location_px = tracks_.point(kPlaceX, t);
    if (!trust_.alive(trust) || !picture.contain(location_px)) continue;
    const bool rebel = tracks_.at(kBelief, t) > 0;
    Edge& edge = (rebel ? result_.edges.rebel : result_.edges.normal).emplace_back();
    edge.id = id;
    edge.rebel = rebel;
    edge.location = location_px;
    edge.predicted = tracks_.point(rebel ? kMovingX : kStaticX, t);
    edge.speed = speed_pxps_[t];
    edge.angle = angle_[t];
    edge.depth_ratio = tracks_.at(kInverseDepth_pm, t) * reference_m;
    edge.age = record.age;
    edge.corner = record.corner >= 0 ? chi.sources[record.corner] : -1;
    edge.trust = trust;
    if (rebel) {
      // So that beta is current.
      edge.origin = location_px - field.dt_s() * tracks_.point(kVelocityX, t);
    } else {
      edge.origin = field.origin(location_px);
      edge.depth_ratio_sigma = std::sqrt(double{tracks_.at(kDepthVariance, t)}) * reference_m;
    }
  }
}

void EdgeExpert::decide(const Chi& chi, const MotionField& field) {
  auto& [edges, verdicts, reasons, log_odds, motion] = result_;
  refill(verdicts, chi.size(), Verdict::pending);
  refill(reasons, chi.size(), Reason::unknown);
  log_odds = {tracks_.columns[kBelief], corners_};
  for (std::size_t t = 0; t < corners_; ++t) {
    const bool rebel = tracks_.at(kBelief, t) > 0, has_motion = tracks_.has_motion(t);
    const bool by_itself = (tracks_.at(kLogOdds, t) > 0) == rebel;
    if (rebel) {
      verdicts[t] = Verdict::rebel;
      reasons[t] = !has_motion ? Reason::inherited
                   : by_itself ? Reason::rebel_edge
                               : Reason::rebel_neighbours;
    } else if (has_motion) {
      verdicts[t] = Verdict::normal;
      reasons[t] = by_itself ? Reason::normal_edge : Reason::normal_neighbours;
    } else {
      reasons[t] = Reason::first_sighting;
    }
  }
  make_edges(chi, field);
}

/// Whether nearly all corners would move by themselves. The camera's motion is then wrong; once all
/// tracks are rebels, none is left to correct it.
bool EdgeExpert::do_all_move() const {
  int count = 0;
  double all = 0, move = 0;
  for (std::size_t c = 0; c < corners_; ++c) {
    if (!tracks_.has_motion(c)) continue;
    const double voice = 1.0 / association_.crowd()[c];
    ++count;
    all += voice;
    move += voice * chance(tracks_.at(kBelief, c));
  }
  return count >= parameters_.neighbours && move > kLeave * all;
}

const EdgeExpert::Result& EdgeExpert::step(const Chi& chi, const MotionField& told,
                                           const MotionField* held) {
  const bool is_after_none = result_.motion == UsedMotion::none;
  if (!(told.dt_s() > 0)) forget();
  take(chi);
  around_.build(chi.locations, parameters_.neighbour_reach_px, parameters_.neighbours);
  estimate_noise(told.dt_s());
  const VelocityError before = velocity_error_;
  bool started = false;
  for (std::size_t t = 0; t < tracks_.size() && !started; ++t) started = tracks_.has_motion(t);
  const MotionField* given = &told;
  UsedMotion motion = UsedMotion::told;
  follow(told, chi);
  if (started && held != nullptr && is_held(*held)) {
    motion = is_confirmed_ ? UsedMotion::held : UsedMotion::none;
    velocity_error_ = before;
    given = held;
    follow(*held, chi);
  }
  const bool is_first_tested = started && !is_confirmed_ && held != nullptr;
  if (is_first_tested && is_first_wrong(told, *held)) motion = UsedMotion::none;
  MotionField field = velocity_error_.without(*given);
  if (predicted_.size() > 0 && motion != UsedMotion::none) {
    field = corrected(field, started);
    // In the second frame no depth is known that could contradict the motion. It is checked only if
    // the motion of the last frame was contradicted.
    if ((started || is_after_none) && is_contradicted(misses_.data(), asked_.size())) {
      motion = UsedMotion::none;
    }
  }
  if (motion == UsedMotion::none) {
    forget();
    std::ranges::fill(track_of_, -1);
  } else if (started) {
    is_confirmed_ = true;
  }
  result_.motion = motion;
  see(field, chi);
  if (field.dt_s() > 0) coast(field);
  couple(field);
  if (do_all_move()) {
    forget();
    result_.motion = UsedMotion::none;
    std::ranges::fill(track_of_, -1);
    see(field, chi);
  }
  decide(chi, field);
  return result_;
}

Explanation EdgeExpert::explain(std::size_t corner) const {
  Explanation said;
  said.track = tracks_.records[corner].id;
  said.age = tracks_.records[corner].age;
  for (std::size_t i = 0; i < kTrackColumns; ++i) said.seen[i] = tracks_.columns[i][corner];
  if (track_of_[corner] >= 0) {
    const auto t = static_cast<std::size_t>(track_of_[corner]);
    said.assigned = predicted_.records[t].id;
    for (std::size_t i = 0; i < kTrackColumns; ++i) said.predicted[i] = predicted_.columns[i][t];
    said.static_spread_px2 = predicted_.static_spread(t, double{said.seen[kSeenNoise2]});
  }
  if (tracks_.has_motion(corner)) {
    said.shown = shown_[corner];
    said.voices = coupling_.voices(static_cast<int>(corner), around_.grid());
  }
  return said;
}

}  // namespace lcs
