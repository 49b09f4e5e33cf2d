/// \file
/// Parameters of the edges (keys `hypotheses.*`). MODEL.md defines each by its formula.
#pragma once

#include <algorithm>
#include <cmath>
#include <numbers>
#include <stdexcept>
#include <string_view>

#include "filter/types/learnt.h"

namespace lcs {

/// The value of a key of `learnt.h`. A missing key is a compile-time error.
consteval double learnt(std::string_view key) {
  for (const auto& [name, value] : kLearnt) {
    if (key == name) return value;
  }
  throw std::invalid_argument("learnt.h lacks the key");
}

struct EdgeParameters {
  /// px: least standard deviation of a corner's place on each axis (whole pixels, FAST). The filter
  /// estimates the excess over it.
  double noise_px = learnt("hypotheses.noise");
  double prior = learnt("hypotheses.prior");  ///< share of corners that move
  /// Log odds of "moves" that a new corner starts with, above the prior: FAST finds movers' corners
  /// again less often.
  double newcomer = learnt("hypotheses.newcomer");
  /// 1/s: rate at which a track jumps to another corner, or a mover changes its image velocity by
  /// as much as that velocity.
  double turnover_ps = learnt("hypotheses.turnover");
  /// The probability of such a change within a frame.
  double turnover(double dt_s) const { return std::min(0.5, turnover_ps * dt_s); }
  /// 1/s: rate at which a corner changes its kind: a mover comes to rest, or a resting one starts.
  double kind_turnover_ps = learnt("hypotheses.kind_turnover");
  /// The probability of such a change within a frame.
  double kind_turnover(double dt_s) const { return std::min(0.5, kind_turnover_ps * dt_s); }
  /// Bound of the log odds of moving: those of a corner whose kind was sure in the last frame.
  double most_log_odds(double dt_s) const {
    const double kind = kind_turnover(dt_s);
    return std::log((1 - kind) / (kind * prior));
  }
  /// Standard deviation of the camera's velocity, as a share of its speed.
  double ego_share = learnt("hypotheses.ego_share");
  double max_speed_pxps = 900;  ///< px/s: the fastest mover that is searched for, rotation removed
  /// px: largest distance of a corner from its track's rotated place.
  double reach_px(double dt_s) const { return max_speed_pxps * dt_s; }
  /// px^2: area of the circle with that radius.
  double reach_area_px2(double dt_s) const {
    return std::numbers::pi * reach_px(dt_s) * reach_px(dt_s);
  }
  int coast = 3;  ///< frames that a track without a corner lives on
  /// Differing bits of two signatures at which same and other place are equally likely. Corners
  /// whose signatures differ more are never paired.
  double bits_even = learnt("hypotheses.bits_even");
  double bits_weight = learnt("hypotheses.bits_weight");  ///< log odds for each bit less
  /// Standard deviation between the steps of neighbours on one body, as a share of the step.
  double step_share = learnt("hypotheses.step_share");
  /// px: distance at which a neighbour's weight has fallen to 0.6.
  double neighbour_reach_px = learnt("hypotheses.neighbour_reach");
  double coupling = learnt("hypotheses.coupling");  ///< J: the most log odds that neighbours add
  int neighbours = 9;                               ///< nearest corners that vote
  /// Crossings for each corner that moves, where a corner is alone; falls with the square of the
  /// number of tracks within `neighbour_reach`.
  double crossings = 2;
  double slide =
      0.15;  ///< way of a crossing off a static point's line, as a share of the way on it
};

}  // namespace lcs
