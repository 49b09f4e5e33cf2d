#include "filter/edges/association.h"

#include <cmath>

#include "filter/edges/gauss.h"
#include "filter/kinematics/geometry.h"
#include "filter/vectors/refill.h"

namespace lcs {
Association::Association(const EdgeParameters& parameters) : parameters_(parameters) {
  for (int bits = 0; bits <= 256; ++bits) {
    likeness_[bits] = (parameters_.bits_even - bits) * parameters_.bits_weight;
    if (likeness_[bits] >= 0) most_bits_ = bits;
  }
}

/// Density of tracks round a corner, 1/px^2.
double Association::clutter_ppx2(std::size_t corner) const {
  const double near = parameters_.neighbour_reach_px;
  return crowd_[corner] / (kPi * near * near);
}

/// Keeps the pair if it is among the likeliest of its corner.
void Association::offer(std::size_t corner, const Pair& pair) {
  Pair* const pairs = &pairs_[corner * most_pairs_];
  std::uint32_t& count = counts_[corner];
  if (count == most_pairs_ && !(pair < pairs[count - 1])) return;
  std::size_t i = count < most_pairs_ ? count++ : count - 1;
  for (; i > 0 && pair < pairs[i - 1]; --i) pairs[i] = pairs[i - 1];
  pairs[i] = pair;
}

void Association::Sought::clear() {
  places.clear();
  tracks.clear();
}

void Association::Sought::build(const Tracks& predicted, double cell_px) {
  grid.build(places, cell_px);
  refill(track_at, places.size());
  refill(signatures, places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    track_at[i] = tracks[grid.index_at(i)];
    signatures[i] = predicted.records[track_at[i]].signature;
  }
}

/// Places all tracks about their rotated places, and those of three sightings where they are
/// expected.
void Association::seek(const Tracks& predicted) {
  followed_.clear();
  all_.clear();
  for (std::size_t t = 0; t < predicted.size(); ++t) {
    all_.places.push_back(predicted.point(kPlaceX, t));
    all_.tracks.push_back(static_cast<int>(t));
    if (predicted.at(kSightings, t) < 3) continue;
    followed_.places.push_back(
        predicted.point(predicted.at(kBelief, t) > 0 ? kMovingX : kStaticX, t));
    followed_.tracks.push_back(static_cast<int>(t));
  }
  followed_.build(predicted, parameters_.neighbour_reach_px);
  all_.build(predicted, parameters_.neighbour_reach_px);
}

/// Adds the pairs of a corner with the tracks that are sought.
/// \param signature null if there is none.
/// \return whether it surely continues one of them: near its prediction, with a signature of
///   which few bits differ.
bool Association::find_pairs(std::size_t corner, const Vec2& x_px, const Signature* signature,
                             const Tracks& predicted, const Sought& sought, double reach_px) {
  bool is_sure = false;
  std::size_t count = sought.grid.find_within(x_px, reach_px, near_);
  if (signature != nullptr) {
    count = loops().alike(*signature, sought.signatures.data(), near_.places.data(), count,
                          most_bits_, alike_.data());
  }
  for (std::size_t i = 0; i < count; ++i) {
    const int place = signature != nullptr ? alike_[i].place : near_.places[i];
    which_[i] = sought.track_at[place];
  }
  const Eigen::Vector2f x = x_px.cast<float>();
  track_loops().densities(predicted.columns.data(), which_.data(), count, x.x(), x.y(),
                          ln_density_.data(), ln_off_.data());
  const float *const place_x = predicted.columns[kPlaceX], *const place_y =
                                                               predicted.columns[kPlaceY];
  const double reach2_px2 = reach_px_ * reach_px_;
  for (std::size_t i = 0; i < count; ++i) {
    // Static points are not followed at steps that are too large for movers, either.
    const Eigen::Vector2f place(place_x[which_[i]], place_y[which_[i]]);
    if ((place - x).squaredNorm() > reach2_px2) continue;
    const double likeness = signature != nullptr ? likeness_[alike_[i].bits] : 0.0;
    // Half as far as a pair may be, in deviations and in bits.
    if (signature != nullptr && 2 * alike_[i].bits <= most_bits_ &&
        ln_off_[i] > -0.5 * (0.5 * kFar) * (0.5 * kFar)) {
      is_sure = true;
    }
    offer(corner, {ln_density_[i] + likeness, which_[i], static_cast<float>(likeness)});
  }
  return is_sure;
}

/// Finds the pairs of all corners.
void Association::find_pairs(const Chi& chi, const Tracks& predicted) {
  refill(alike_, predicted.size());
  refill_column(which_, predicted.size());
  refill_column(ln_density_, predicted.size());
  refill_column(ln_off_, predicted.size());
  // Of pairs with signatures one vector is kept. Without signatures a new mover's pairs are all
  // alike, and only the votes tell them apart.
  most_pairs_ = chi.signatures.empty() ? kCrowd : kLanes;
  refill(pairs_, chi.size() * most_pairs_);
  refill(counts_, chi.size());
  for (std::vector<float>* column : {&step_x_, &step_y_, &likeness_of_}) {
    refill_column(*column, pairs_.size());
  }
  ln_clutter_.clear();
  for (std::size_t c = 0; c < chi.size(); ++c) {
    const Vec2& x = chi.locations[c];
    const Signature* signature = chi.signatures.empty() ? nullptr : &chi.signatures[c];
    if (!find_pairs(c, x, signature, predicted, followed_, close_px_)) {
      counts_[c] = 0;
      find_pairs(c, x, signature, predicted, all_, reach_px_);
    }
    crowd_[c] = 1 + static_cast<float>(all_.grid.count_within(x, parameters_.neighbour_reach_px));
    const float ln_clutter =
        ln_clutter_.emplace_back(static_cast<float>(std::log(clutter_ppx2(c))));
    for (std::size_t p = c * most_pairs_, end = p + counts_[c]; p < end; ++p) {
      Pair& pair = pairs_[p];
      pair.weight -= ln_clutter;
      step_x_[p] = static_cast<float>(x.x()) - predicted.at(kPlaceX, pair.track);
      step_y_[p] = static_cast<float>(x.y()) - predicted.at(kPlaceY, pair.track);
      likeness_of_[p] = pair.likeness;
    }
  }
}

/// The pair of a corner with the largest weight, the votes of its neighbours included. A vote is
/// ln((1 + ratio) / 2): the neighbour is detected again at even odds.
/// \param others its neighbours, nearest first.
Association::Match Association::best_pair(std::size_t corner, std::span<const Neighbour> others,
                                          const PairColumns& pairs) {
  const double near = parameters_.neighbour_reach_px, far2_px2 = kFar * kFar * near * near;
  std::size_t count = 0;
  for (; count < others.size() && others[count].distance2 <= far2_px2; ++count) {
    voices_[count] = others[count].index;
    voice_weights_[count] = static_cast<float>(others[count].distance2);
    voice_clutter_[count] = ln_clutter_[static_cast<std::size_t>(others[count].index)];
  }
  loops().exponentials(voice_weights_.data(), count, static_cast<float>(-0.5 / (near * near)));
  Match best{0, static_cast<int>(corner), -1, 0};
  std::array<float, kLanes> votes;
  const std::size_t first = corner * most_pairs_, end = first + counts_[corner];
  for (std::size_t p = first; p < end; ++p) {
    const std::size_t lane = (p - first) % kLanes;
    if (lane == 0) {
      loops().votes(pairs, voices_.data(), voice_weights_.data(), voice_clutter_.data(), count, p,
                    votes.data());
    }
    const Pair& pair = pairs_[p];
    const double weight = pair.weight + votes[lane];
    if (weight > best.weight || (weight == best.weight && pair.track < best.track)) {
      best = {weight, best.corner, pair.track, pair.likeness};
    }
  }
  return best;
}

const std::vector<int>& Association::match(const Chi& chi, const Neighbourhood& around,
                                           Tracks& predicted, const TrackFrame& frame) {
  refill(track_of_, chi.size() + kLanes, -1);
  refill_column(chance_ppx2_, chi.size());
  refill(crowd_, chi.size() + kLanes, 1.0F);
  if (predicted.size() == 0 || chi.size() == 0) return track_of_;
  track_loops().expect(frame, predicted.size(), predicted.columns.data());
  reach_px_ = parameters_.reach_px(double{frame.dt_s});
  close_px_ = kFar * kFar * std::sqrt(double{frame.noise2_px2});
  seek(predicted);
  find_pairs(chi, predicted);
  const PairColumns pairs = {step_x_.data(),
                             step_y_.data(),
                             likeness_of_.data(),
                             counts_.data(),
                             most_pairs_,
                             4 * frame.noise2_px2,
                             static_cast<float>(parameters_.step_share * parameters_.step_share)};
  const auto voices = static_cast<std::size_t>(parameters_.neighbours);
  refill_column(voices_, voices);
  refill_column(voice_weights_, voices);
  refill_column(voice_clutter_, voices);
  matches_.clear();
  for (std::size_t c = 0; c < chi.size(); ++c) {
    if (counts_[c] == 0) continue;
    const Match best = best_pair(c, around.of(c), pairs);
    if (best.track >= 0) matches_.push_back(best);
  }
  std::ranges::sort(matches_, [](const Match& a, const Match& b) {
    return a.weight > b.weight || (a.weight == b.weight && a.corner < b.corner);
  });
  refill(taken_, predicted.size());
  for (const Match& match : matches_) {
    if (taken_[match.track]) continue;
    taken_[match.track] = 1;
    track_of_[match.corner] = match.track;
    if (chi.signatures.empty()) continue;
    chance_ppx2_[match.corner] = static_cast<float>(
        clutter_ppx2(static_cast<std::size_t>(match.corner)) * std::exp(-match.signature));
  }
  return track_of_;
}

}  // namespace lcs
