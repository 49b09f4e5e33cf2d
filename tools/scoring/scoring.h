/// \file
/// Computes a run's figures from its recording. Definitions are in `tools/scoring/SCORING.md`.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::bench {

/// Names and values, such as ("rebel.f1", 0.87). An undefined figure (such as recall without a
/// rebel in the truth) has no value. Every recording has every metric, in the same order.
using Metrics = std::vector<std::pair<std::string, std::optional<double>>>;

/// \throws std::invalid_argument if the counts of corners, verdicts and truth differ in a frame.
Metrics score(const Recording& recording);

/// The value of a metric by name. \throws std::out_of_range for an unknown name.
std::optional<double> value(const Metrics& metrics, const std::string& name);

/// The counts of corners for precision and recall.
struct RebelCounts {
  int true_rebels = 0;   ///< TP: verdict and label rebel
  int false_rebels = 0;  ///< FP: verdict rebel, label fixed
  /// The TP that recall counts: from N frames after their object's first.
  int found_rebels = 0;
  int missed_rebels = 0;  ///< FN: label rebel, any other verdict, counted by recall

  std::optional<double> precision() const;
  std::optional<double> recall() const;
  /// The harmonic mean; undefined if recall is undefined, 0 if recall is 0.
  std::optional<double> f1() const;

  RebelCounts& operator+=(const RebelCounts& other);
};

/// The counts of each frame, in order; all 0 during the warm-up.
/// \throws std::invalid_argument as `score`.
std::vector<RebelCounts> score_frames(const Recording& recording);

}  // namespace lcs::bench
