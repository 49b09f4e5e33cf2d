#include "filter/edges/association.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "filter/edges/gauss.h"
#include "filter/matching/refill.h"

namespace lcs {
namespace {

/// px: within which corners are counted for their density.
constexpr double kClutterReach_px = 40;
/// Of a corner's pairs so many are asked about.
constexpr std::size_t kMostPairs = 60;
/// Standard deviations of a step beyond which a neighbour does not agree.
constexpr double kFarStep = 2.5;

}  // namespace

Association::Association(const HypothesisParameters& parameters) : parameters_(parameters) {
  for (int bits = 0; bits <= 256; ++bits) {
    const auto deviation2 = [&](double mean) {
      const double z =
          (std::max<double>(bits, parameters_.bits_same) - mean) / parameters_.bits_spread;
      return z * z;
    };
    likeness_[bits] =
        0.5 * (deviation2(parameters_.bits_other) - deviation2(parameters_.bits_same));
  }
}

double Association::reach_px(double dt_s) const {
  return parameters_.max_speed_pxps * dt_s;
}

double Association::reach_area_px2(double dt_s) const {
  const double reach = reach_px(dt_s);
  return std::numbers::pi * reach * reach;
}

void Association::find_pairs(const Chi& chi, std::span<const Track> predicted, double noise2_px2,
                             double dt_s) {
  const double reach = reach_px(dt_s);
  const double anywhere = 1 / reach_area_px2(dt_s), wrong = parameters_.wrong;
  const bool looks = !chi.signatures.empty();
  places_.clear();
  for (const Track& track : predicted) places_.push_back(track.place_px);
  tracks_.build(places_, std::max(20.0, reach / 2));
  pairs_.clear();
  // As many as there may ever be of so many corners, so that no later frame asks for more.
  pairs_.reserve(chi.size() * kMostPairs + predicted.size());
  first_.assign(1, 0);
  clutter_.clear();
  for (std::size_t c = 0; c < chi.size(); ++c) {
    const Vec2& x = chi.locations[c];
    int round = 1;
    tracks_.visit_within(x, kClutterReach_px, [&](int, double) { ++round; });
    clutter_.push_back(round / (std::numbers::pi * kClutterReach_px * kClutterReach_px));
    tracks_.visit_within(x, reach, [&](int t, double) {
      const Track& track = predicted[t];
      const double likeness = looks ? likeness_[distance(chi.signatures[c], track.signature)] : 0.0;
      if (likeness < 0) return;
      const double moves =
          std::clamp(chance(track.belief), parameters_.prior, 1 - parameters_.prior);
      const double still = track.as_static.density(x, noise2_px2);
      const double moving = track.has_motion() ? track.as_moving.density(x, noise2_px2) : anywhere;
      const double density =
          (1 - wrong) * ((1 - moves) * still + moves * moving) + wrong * anywhere;
      pairs_.push_back(
          {t, x - track.place_px, likeness, std::log(density / clutter_.back()) + likeness});
    });
    const auto begin = pairs_.begin() + static_cast<std::ptrdiff_t>(first_.back());
    const auto heavier = [](const Pair& a, const Pair& b) {
      return a.weight > b.weight || (a.weight == b.weight && a.track < b.track);
    };
    if (pairs_.size() > first_.back() + kMostPairs) {
      std::nth_element(begin, begin + kMostPairs, pairs_.end(), heavier);
      pairs_.resize(first_.back() + kMostPairs);
    }
    std::sort(begin, pairs_.end(), heavier);
    first_.push_back(pairs_.size());
  }
}

/// ln of the ratio by which those in near_ bear a pair out.
double Association::ask_neighbours(const Pair& pair, double noise2_px2) const {
  const double unlike = parameters_.step_share * parameters_.step_share;
  const double variance = 4 * noise2_px2 + unlike * pair.step_px.squaredNorm();
  const double share = parameters_.voters_share, none_agrees = std::log(1 - share);
  double sum = 0;
  for (std::size_t k = 0; k < near_.size(); ++k) {
    const int other = near_[k].index;
    constexpr double kNone = -std::numeric_limits<double>::infinity();
    double best = kNone;  // ln
    for (const Pair& theirs : pairs_of(other)) {
      const double apart2 = (theirs.step_px - pair.step_px).squaredNorm();
      if (apart2 > kFarStep * kFarStep * variance) continue;
      best = std::max(best, -0.5 * apart2 / variance + theirs.signature);
    }
    if (best == kNone) {  // as for most
      sum += voices_[k] * none_agrees;
      continue;
    }
    const double agrees = std::exp(best) / (2 * std::numbers::pi * variance * clutter_[other]);
    sum += voices_[k] * std::log(1 - share + share * agrees);
  }
  return sum;
}

const std::vector<int>& Association::match(const Chi& chi, std::span<const Track> predicted,
                                           double noise2_px2, double dt_s) {
  refill(track_of_, chi.size(), -1);
  if (predicted.empty() || chi.size() == 0) return track_of_;
  find_pairs(chi, predicted, noise2_px2, dt_s);
  corners_.build(chi.locations, parameters_.voters_reach_px / 2);
  const double half_reach = 0.5 * parameters_.voters_reach_px;
  matches_.clear();
  for (std::size_t c = 0; c < chi.size(); ++c) {
    const auto pairs = pairs_of(c);
    if (pairs.empty()) continue;
    corners_.nearest(
        chi.locations[c], parameters_.voters_reach_px, static_cast<std::size_t>(parameters_.voters),
        [&](int other) { return other != static_cast<int>(c); }, near_);
    voices_.clear();
    for (const Neighbour& other : near_) {
      voices_.push_back(std::exp(-0.5 * other.distance2 / (half_reach * half_reach)));
    }
    Match best{0, static_cast<int>(c), -1};
    for (const Pair& pair : pairs) {
      const double weight = pair.weight + ask_neighbours(pair, noise2_px2);
      if (weight > best.weight) best = {weight, best.corner, pair.track};
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
  }
  return track_of_;
}

}  // namespace lcs
