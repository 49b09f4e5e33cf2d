/// \file
/// The figures of a run, from its recording alone. Definitions are in `tools/bench/SCORING.md`.
#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/bench/recording.h"

namespace lcs::bench {

/// Sightings that a rebel needs (the paper's N): warm-up, and the floor of latency plus one.
inline constexpr int kSightings = 3;

/// Flat and ordered: ("rebel.f1", 0.87). An undefined figure (no rebel in the truth) has no value.
using Metrics = std::vector<std::pair<std::string, std::optional<double>>>;

Metrics score(const Recording& recording);

/// Counts behind precision and recall of one frame, for frames.csv and plots.
struct FrameScore {
  int true_rebels = 0;    ///< TP
  int false_rebels = 0;   ///< FP
  int missed_rebels = 0;  ///< FN
};
std::vector<FrameScore> score_frames(const Recording& recording);

/// Value of a metric by name. \throws std::out_of_range for an unknown name.
std::optional<double> value(const Metrics& metrics, const std::string& name);

}  // namespace lcs::bench
