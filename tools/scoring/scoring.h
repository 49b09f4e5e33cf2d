/// \file
/// Computes a run's figures from its frames. Definitions are in `tools/scoring/SCORING.md`.
#pragma once

#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/recording/recording.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/statistics.h"

namespace lcs::scoring {

struct ObjectDetection;

/// Names and values, such as ("rebel.f1", 0.87). An undefined figure (such as recall without a
/// rebel in the truth) has no value. Every recording has every metric, in the same order.
using Metrics = std::vector<std::pair<std::string, std::optional<double>>>;

/// The value of a metric by name. \throws std::out_of_range for an unknown name.
std::optional<double> value(const Metrics& metrics, std::string_view name);

/// The counts of corners for precision and recall.
struct RebelCounts {
  int true_rebels = 0;   ///< TP: verdict and label rebel
  int false_rebels = 0;  ///< FP: verdict rebel, label fixed
  /// The TP that recall counts: from N frames after their object's first.
  int found_rebels = 0;
  int missed_rebels = 0;  ///< FN: label rebel, any other verdict, counted by recall

  std::optional<double> precision() const { return ratio(true_rebels, true_rebels + false_rebels); }
  std::optional<double> recall() const { return ratio(found_rebels, found_rebels + missed_rebels); }
  /// The harmonic mean; undefined if recall is undefined, 0 if recall is 0.
  std::optional<double> f1() const;

  RebelCounts& operator+=(const RebelCounts& other);
};

/// The outcome of a corner, from its label and its verdict.
enum class CornerOutcome : std::uint8_t {
  uncounted,     ///< in the warm-up, or its label is neither fixed nor rebel
  fixed,         ///< TN: label fixed, verdict other than rebel
  false_rebel,   ///< FP: label fixed, verdict rebel
  found,         ///< TP: label and verdict rebel
  found_early,   ///< TP within `kSightings` frames of its object's first; recall ignores it
  missed,        ///< FN: label rebel, verdict other than rebel
  missed_early,  ///< missed within `kSightings` frames; recall ignores it
};

/// The rebels of a single frame.
struct FrameScore {
  std::vector<CornerOutcome> outcomes;  ///< of each corner
  RebelCounts rebels;                   ///< all 0 during the warm-up
};

/// Scores a run frame by frame, in order. It keeps counts, and a few numbers of each frame: about
/// 120 bytes, and 32 more for each square that is right.
class Scorer {
 public:
  /// Uses the detector and the truth of the run.
  explicit Scorer(const recording::RunInfo& run);
  ~Scorer();
  Scorer(Scorer&&) noexcept;

  /// \throws std::invalid_argument if the counts of corners, verdicts and truth differ; then the
  ///   frame is not added.
  FrameScore add(const recording::FrameRecord& frame);

  /// \name Of the frames so far. \param world the simulation's warnings; absent without one.
  ///@{
  Metrics metrics(const std::optional<sim::Warnings>& world) const;
  std::vector<recording::Warned> warned(const std::optional<sim::Warnings>& world) const;
  int frames() const;
  const std::map<int, ObjectDetection>& detections() const;
  ///@}

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// The figures of a whole recording. \throws as `Scorer::add`.
Metrics score(const recording::Recording& recording);

}  // namespace lcs::scoring
