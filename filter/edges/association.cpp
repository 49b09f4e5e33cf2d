#include "filter/edges/association.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "filter/edges/gauss.h"
#include "filter/matching/refill.h"

namespace lcs {
namespace {

/// ln: what is less is lost in rounding.
const double kNone = std::log(std::numeric_limits<float>::epsilon());

}  // namespace

Association::Association(const HypothesisParameters& parameters) : parameters_(parameters) {
  for (int bits = 0; bits <= 256; ++bits) {
    likeness_[bits] = (parameters_.bits_even - bits) * parameters_.bits_weight;
  }
}

double Association::reach_px(double dt_s) const {
  return parameters_.max_speed_pxps * dt_s;
}

double Association::reach_area_px2(double dt_s) const {
  const double reach = reach_px(dt_s);
  return std::numbers::pi * reach * reach;
}

/// Density of tracks about a corner.
double Association::clutter_ppx2(std::size_t corner) const {
  const double near = parameters_.coupling_reach_px;
  return crowd_[corner] / (std::numbers::pi * near * near);
}

void Association::find_pairs(const Chi& chi, std::span<const Track> predicted, double noise2_px2,
                             double dt_s) {
  const double reach = reach_px(dt_s);
  const double anywhere = 1 / reach_area_px2(dt_s), wrong = parameters_.turnover(dt_s);
  const double near = parameters_.coupling_reach_px;
  const bool looks = !chi.signatures.empty();
  places_.clear();
  signatures_.clear();
  for (const Track& track : predicted) {
    places_.push_back(track.place_px);
    signatures_.push_back(track.signature);
  }
  tracks_.build(places_, std::max(20.0, reach / 2));
  pairs_.clear();
  // As many as there may ever be of so many corners, so that no later frame asks for more.
  pairs_.reserve(chi.size() * kCrowd + predicted.size());
  first_.assign(1, 0);
  crowd_.clear();
  for (std::size_t c = 0; c < chi.size(); ++c) {
    const Vec2& x = chi.locations[c];
    int round = 1;
    tracks_.visit_within(x, near, [&](int, double) { ++round; });
    crowd_.push_back(round);
    const double clutter = clutter_ppx2(c);
    tracks_.visit_within(x, reach, [&](int t, double) {
      const double likeness = looks ? likeness_[distance(chi.signatures[c], signatures_[t])] : 0.0;
      if (likeness < 0) return;
      const Track& track = predicted[t];
      const double moves =
          std::clamp(chance(track.belief), parameters_.prior, 1 - parameters_.prior);
      const double still = track.as_static.density(x, noise2_px2);
      const double moving = track.has_motion() ? track.as_moving.density(x, noise2_px2) : anywhere;
      const double density =
          (1 - wrong) * ((1 - moves) * still + moves * moving) + wrong * anywhere;
      pairs_.push_back({t, x - track.place_px, likeness, std::log(density / clutter) + likeness});
    });
    if (pairs_.size() > first_.back() + kCrowd) {
      const auto begin = pairs_.begin() + static_cast<std::ptrdiff_t>(first_.back());
      std::nth_element(begin, begin + kCrowd, pairs_.end(), [](const Pair& a, const Pair& b) {
        return a.weight > b.weight || (a.weight == b.weight && a.track < b.track);
      });
      pairs_.resize(first_.back() + kCrowd);
    }
    first_.push_back(pairs_.size());
  }
  const auto count = static_cast<Eigen::Index>(pairs_.size());
  if (step_x_.size() < count) {
    for (Eigen::ArrayXf* list : {&step_x_, &step_y_, &likeness_of_})
      list->resize(count + count / 2);
  }
  for (Eigen::Index p = 0; p < count; ++p) {
    step_x_[p] = static_cast<float>(pairs_[p].step_px.x());
    step_y_[p] = static_cast<float>(pairs_[p].step_px.y());
    likeness_of_[p] = static_cast<float>(pairs_[p].signature);
  }
}

/// ln of the ratio by which those in near_ bear a pair out. Each is found again, or not, at even
/// odds.
double Association::ask_neighbours(const Pair& pair, double noise2_px2) const {
  const double unlike = parameters_.step_share * parameters_.step_share;
  const double variance = 4 * noise2_px2 + unlike * pair.step_px.squaredNorm();
  const auto x = static_cast<float>(pair.step_px.x()), y = static_cast<float>(pair.step_px.y());
  const auto per_px2 = static_cast<float>(-0.5 / variance);
  double sum = 0;
  for (std::size_t k = 0; k < near_.size(); ++k) {
    const int other = near_[k].index;
    const auto first = static_cast<Eigen::Index>(first_[other]);
    const auto count = static_cast<Eigen::Index>(first_[other + 1]) - first;
    const double best =  // ln
        count == 0 ? kNone
                   : (per_px2 * ((step_x_.segment(first, count) - x).square() +
                                 (step_y_.segment(first, count) - y).square()) +
                      likeness_of_.segment(first, count))
                         .maxCoeff();
    if (best < kNone) {  // as for most
      sum -= voices_[k] * std::numbers::ln2;
      continue;
    }
    const double agrees = std::exp(best) / (2 * std::numbers::pi * variance *
                                            clutter_ppx2(static_cast<std::size_t>(other)));
    sum += voices_[k] * std::log(0.5 * (1 + agrees));
  }
  return sum;
}

const std::vector<int>& Association::match(const Chi& chi, std::span<const Track> predicted,
                                           double noise2_px2, double dt_s) {
  refill(track_of_, chi.size(), -1);
  refill(chance_ppx2_, chi.size());
  if (predicted.empty() || chi.size() == 0) return track_of_;
  find_pairs(chi, predicted, noise2_px2, dt_s);
  const double near = parameters_.coupling_reach_px;
  corners_.build(chi.locations, near);
  matches_.clear();
  for (std::size_t c = 0; c < chi.size(); ++c) {
    const std::span pairs(pairs_.data() + first_[c], first_[c + 1] - first_[c]);
    if (pairs.empty()) continue;
    corners_.nearest(
        chi.locations[c], kFar * near, static_cast<std::size_t>(parameters_.voters),
        [&](int other) { return other != static_cast<int>(c); }, near_);
    voices_.clear();
    for (const Neighbour& other : near_) {
      voices_.push_back(std::exp(-0.5 * other.distance2 / (near * near)));
    }
    Match best{0, static_cast<int>(c), -1, 0};
    for (const Pair& pair : pairs) {
      const double weight = pair.weight + ask_neighbours(pair, noise2_px2);
      if (weight > best.weight || (weight == best.weight && pair.track < best.track)) {
        best = {weight, best.corner, pair.track, pair.signature};
      }
    }
    if (best.track >= 0) matches_.push_back(best);
  }
  std::sort(matches_.begin(), matches_.end(), [](const Match& a, const Match& b) {
    return a.weight > b.weight || (a.weight == b.weight && a.corner < b.corner);
  });
  refill(taken_, predicted.size());
  for (const Match& match : matches_) {
    if (taken_[match.track]) continue;
    taken_[match.track] = 1;
    track_of_[match.corner] = match.track;
    if (chi.signatures.empty()) continue;
    chance_ppx2_[match.corner] =
        clutter_ppx2(static_cast<std::size_t>(match.corner)) * std::exp(-match.signature);
  }
  return track_of_;
}

}  // namespace lcs
