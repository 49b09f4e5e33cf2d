/// \file
/// The trust factor Tr: how far a landmark or layer is believed (the paper's section "Trust
/// Factor").
#pragma once

#include <algorithm>

namespace lcs {

/// The three ranks of one expert, Tr_c <= Tr_s <= Tr_m.
struct TrustRanks {
  int critical = 2;  ///< Tr_c: below it, the item is deleted
  int standard = 3;  ///< Tr_s: from it on, the item is tracked with confidence
  int maximum = 5;   ///< Tr_m: never above it; a layer that reaches it makes an ignorance region

  /// (Tr_c + Tr_s) / 2, rounded up: new normal edges and circles.
  int initial_normal() const { return std::min((critical + standard + 1) / 2, maximum); }
  /// Above Tr_s, as rebels are harder to track: Tr_s + 2.
  int initial_rebel() const { return std::min(standard + 2, maximum); }
  /// New squares.
  int initial_square() const { return standard; }
  /// After making an ignorance region a layer is looked at for two frames before it can make
  /// another.
  int after_ignoring() const { return std::max(maximum - 2, critical); }

  int raised(int trust) const { return std::min(trust + 1, maximum); }
  bool alive(int trust) const { return trust >= critical; }
};

}  // namespace lcs
