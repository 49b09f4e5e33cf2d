/// \file
/// The trust factor Tr: certainty of a landmark or layer (the paper's section "Trust Factor").
#pragma once

#include <algorithm>
#include <cmath>

namespace lcs {

/// The three ranks of one expert, Tr_c <= Tr_s <= Tr_m.
struct TrustRanks {
  int critical = 2;  ///< Tr_c: items below it are deleted
  int standard = 3;  ///< Tr_s: items from it on are tracked with confidence
  int maximum = 5;   ///< Tr_m: upper limit; a layer that reaches it makes an ignorance region

  /// Of new normal edges and circles: (Tr_c + Tr_s) / 2, rounded up.
  int initial_normal() const { return std::min((critical + standard + 1) / 2, maximum); }
  /// Of new rebels: Tr_s + 2, as rebels are harder to track.
  int initial_rebel() const { return std::min(standard + 2, maximum); }
  /// Of new squares.
  int initial_square() const { return standard; }
  /// After an ignorance region, a layer is observed for two frames before it can make another.
  int after_ignoring() const { return std::max(maximum - 2, critical); }

  /// From critical to maximum, by the certainty of a decision, from 0 to 1.
  int of_certainty(double sure) const {
    return critical + static_cast<int>(sure * (maximum - critical) + 0.5);
  }
  /// The same by its log odds.
  int of_log_odds(double log_odds) const {
    return of_certainty(std::abs(std::tanh(0.5 * log_odds)));
  }

  int raised(int trust) const { return std::min(trust + 1, maximum); }
  bool alive(int trust) const { return trust >= critical; }
};

}  // namespace lcs
