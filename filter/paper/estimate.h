/// \file
/// How the paper takes a measurement in.
#pragma once

#include "filter/trust.h"

namespace lcs::paper {

/// The estimate that the paper applies to every property of a landmark or layer,
///   P^ = ((Tr - Tr_c) P' + P) / ((Tr - Tr_c) + 1):
/// the more trusted, the slower to follow. Needs Tr >= Tr_c, that is, a living item.
template <typename T>
T estimate(int trust, const TrustRanks& ranks, const T& predicted, const T& measured) {
  const double weight = trust - ranks.critical;
  return (weight * predicted + measured) / (weight + 1);
}

}  // namespace lcs::paper
