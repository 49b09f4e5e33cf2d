/// \file
/// The figures of a run, from its recording alone. Definitions are in `tools/scoring/SCORING.md`.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::bench {

/// Flat and ordered: ("rebel.f1", 0.87). An undefined figure (no rebel in the truth) has no value.
/// Every recording has every metric, in the same order.
using Metrics = std::vector<std::pair<std::string, std::optional<double>>>;

/// \throws std::invalid_argument for a recording in which corners, verdicts and truth do not pair.
Metrics score(const Recording& recording);

/// Value of a metric by name. \throws std::out_of_range for an unknown name.
std::optional<double> value(const Metrics& metrics, const std::string& name);

/// Counts of corners behind precision and recall.
struct RebelCounts {
  int true_rebels = 0;   ///< TP: verdict and label rebel
  int false_rebels = 0;  ///< FP: verdict rebel, label fixed
  /// The TP that recall counts: from N frames after the first of their object.
  int found_rebels = 0;
  int missed_rebels = 0;  ///< FN: label rebel and counted by recall, any other verdict

  std::optional<double> precision() const;
  std::optional<double> recall() const;
  /// Harmonic mean; undefined where recall is, 0 where recall is 0.
  std::optional<double> f1() const;

  RebelCounts& operator+=(const RebelCounts& other);
};

/// Counts of each frame, in order; all 0 during the warm-up.
/// \throws std::invalid_argument as `score`.
std::vector<RebelCounts> score_frames(const Recording& recording);

}  // namespace lcs::bench
