/// \file
/// `lcs.json` of a generated sequence: what a replay needs beyond the other files for the very bits
/// of the run. That is how the detectors were set, and the mounting and the start in the rover's
/// own frame: the same poses as `sensor.yaml` and the truth have them, but a product of rounded
/// matrices does not give its factors back.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::sequence {

inline constexpr const char* kSettingsFile = "lcs.json";
/// What a replay is scored by (`bench::read_seen`), times as the pictures' names have them.
inline constexpr const char* kTruthFile = "truth.jsonl";

struct ReplaySettings {
  /// Name, origin, seed, rates, noise, odometry, detection and filter of the scenario; the rest is
  /// left as it is by default.
  scenario::Scenario scenario;
  sim::Calibration calibration;
  std::int64_t start_ns = 0;  ///< time 0 of the run, in the sequence's own time
};

/// \param origin the world that the pictures are of, as the simulation has it.
std::string settings_text(const scenario::Scenario& scenario, const sim::Calibration& calibration,
                          const std::optional<scenario::Origin>& origin);

/// \throws std::runtime_error naming file and key.
ReplaySettings read_settings(const std::filesystem::path& file);

}  // namespace lcs::sequence
