/// \file
/// The paper's update of an estimate by a measurement.
#pragma once

#include "filter/types/trust.h"

namespace lcs::paper {

/// The paper's estimate of every property of a landmark or layer,
///   P^ = ((Tr - Tr_c) P' + P) / ((Tr - Tr_c) + 1):
/// the higher the trust, the slower it follows. Needs Tr >= Tr_c.
template <typename T>
T estimate(int trust, const TrustRanks& ranks, const T& predicted, const T& measured) {
  const double weight = trust - ranks.critical;
  return (weight * predicted + measured) / (weight + 1);
}

}  // namespace lcs::paper
