#include "tests/study/step_tracks.h"

#include <algorithm>
#include <cmath>

#include "filter/edges/gauss.h"
#include "filter/vectors/refill.h"

namespace lcs::study {

StepTracks::StepTracks(const Intrinsics& camera, const EdgeParameters& parameters,
                       const TrustRanks& trust, const Rules& rules)
    : camera_(camera),
      parameters_(parameters),
      trust_(trust),
      rules_(rules),
      association_(parameters),
      coupling_(parameters) {}

void StepTracks::forget() {
  tracks_.records.clear();
  predicted_.records.clear();
  noise_ = {};
}

void StepTracks::take(const Chi& chi) {
  corners_ = chi.size();
  refill_column(x_px_, corners_);
  refill_column(y_px_, corners_);
  for (std::size_t c = 0; c < corners_; ++c) {
    x_px_[c] = static_cast<float>(chi.locations[c].x());
    y_px_[c] = static_cast<float>(chi.locations[c].y());
  }
}

/// (17), the noise of this frame's corners.
void StepTracks::estimate_noise(double dt_s) {
  const double least2 = parameters_.noise_px * parameters_.noise_px;
  noise_.fade(1 - parameters_.turnover(dt_s));
  last_noise2_px2_ = noise2_px2_;
  noise2_px2_ = std::max(least2, noise_.variance_px2(least2, parameters_.neighbours));
}

TrackFrame StepTracks::frame_of(const MotionField& field) const {
  TrackFrame frame = track_frame(camera_, field, parameters_);
  frame.noise2_px2 = static_cast<float>(noise2_px2_);
  frame.last_noise2_px2 = static_cast<float>(last_noise2_px2_);
  return frame;
}

Sightings StepTracks::sightings() const {
  return {x_px_.data(), y_px_.data(), track_of_.data(), association_.chance_ppx2(),
          association_.crowd()};
}

/// (1) to (7): predicts the tracks and assigns the corners to them.
void StepTracks::follow(const MotionField& field, const Chi& chi) {
  const TrackFrame frame = frame_of(field);
  const std::size_t count = tracks_.size();
  predicted_.columns.make(count);
  const Eigen::Matrix<float, 3, 3, Eigen::RowMajor> turn = field.homography()->cast<float>();
  for (const TrackColumn x : {kPlaceX, kStaticX, kMovingX}) {
    track_loops().rotate(turn.data(), tracks_.columns[x], tracks_.columns[x + 1], count,
                         predicted_.columns[x], predicted_.columns[x + 1]);
  }
  track_loops().predict(frame, tracks_.columns.data(), count, predicted_.columns.data());
  copy_over(tracks_.records, predicted_.records);
  for (Tracks::Record& record : predicted_.records) {
    record.corner = -1;
    ++record.age;
  }
  const Neighbourhood& voters = rules_.votes ? around_ : nobody_;
  copy_over(association_.match(chi, voters, predicted_, frame), track_of_);
}

/// (12) to (17): updates the tracks by their sightings. Corners without a track start one.
void StepTracks::see(const MotionField& field, const Chi& chi) {
  tracks_.columns.make(corners_ + predicted_.size());
  refill(tracks_.records, corners_);
  refill_column(kept_, corners_);
  const Misses misses = track_loops().see(frame_of(field), predicted_.columns.data(), sightings(),
                                          corners_, tracks_.columns.data(), kept_.data());
  noise_.add(misses.sum_px2, misses.weight);
  for (std::size_t c = 0; c < corners_; ++c) {
    Tracks::Record& record = tracks_.records[c];
    if (track_of_[c] >= 0) {
      record = predicted_.records[static_cast<std::size_t>(track_of_[c])];
      predicted_.records[static_cast<std::size_t>(track_of_[c])].corner = static_cast<int>(c);
    }
    if (kept_[c] == 0) record = {.id = next_id_++};
    record.corner = static_cast<int>(c);
    record.unseen = 0;
    if (!chi.signatures.empty()) record.signature = chi.signatures[c];
  }
}

/// (16)
void StepTracks::coast(const MotionField& field) {
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

/// The beliefs: each track's own log odds, 0 of a track seen once; with the rule of coupling (18),
/// (19), (34) its neighbours' too.
void StepTracks::believe(const MotionField& field) {
  float* const belief = tracks_.columns[kBelief];
  if (!rules_.coupling) {
    for (std::size_t c = 0; c < corners_; ++c) {
      belief[c] = tracks_.has_motion(c) ? tracks_.at(kLogOdds, c) : 0;
    }
    return;
  }
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
  for (std::size_t c = 0; c < corners_; ++c) belief[c] = static_cast<float>(beliefs[c]);
}

/// (20), of the tracks with a motion that are trusted and in the picture, by rising id.
void StepTracks::make_edges(const Chi& chi, const MotionField& field) {
  const std::size_t count = tracks_.size();
  refill_column(speed_pxps_, count);
  refill_column(angle_, count);
  refill_column(sure_, count);
  track_loops().image_motion(frame_of(field), tracks_.columns.data(), count, field.moving(),
                             speed_pxps_.data(), angle_.data());
  loops().half_tanh(tracks_.columns[kBelief], sure_.data(), count);
  const Pixels picture{camera_.width_px, camera_.height_px};
  order_.clear();
  for (std::size_t t = 0; t < count; ++t) {
    if (tracks_.has_motion(t)) order_.emplace_back(tracks_.records[t].id, t);
  }
  std::ranges::sort(order_);
  const double reference_m = field.reference_depth_m();
  result_.edges.normal.clear();
  result_.edges.rebel.clear();
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
    edge.corner = record.corner >= 0 ? chi.sources[static_cast<std::size_t>(record.corner)] : -1;
    edge.trust = trust;
    if (rebel) {
      edge.origin = location_px - field.dt_s() * tracks_.point(kVelocityX, t);
    } else {
      edge.origin = field.origin(location_px);
      edge.depth_ratio_sigma = std::sqrt(double{tracks_.at(kDepthVariance, t)}) * reference_m;
    }
  }
}

void StepTracks::decide(const Chi& chi, const MotionField& field) {
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

const EdgeExpert::Result& StepTracks::step(const Chi& chi, const MotionField& field) {
  if (!(field.dt_s() > 0)) forget();
  take(chi);
  around_.build(chi.locations, parameters_.neighbour_reach_px, parameters_.neighbours);
  nobody_.build(chi.locations, parameters_.neighbour_reach_px, 0);
  estimate_noise(field.dt_s());
  follow(field, chi);
  see(field, chi);
  if (field.dt_s() > 0) coast(field);
  believe(field);
  decide(chi, field);
  return result_;
}

}  // namespace lcs::study
