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
#include <utility>

#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::sequence {

inline constexpr const char* kSettingsFile = "lcs.json";
/// What a replay is scored by (`bench::read_seen`), times as the pictures' names have them.
inline constexpr const char* kTruthFile = "truth.jsonl";

/// What an IMU's noise is called in it, and as far as Kalibr knows it in `sensor.yaml`.
inline constexpr std::pair<const char*, double scenario::ImuNoise::*> kImuNoise[] = {
    {"gyroscope_noise_density", &scenario::ImuNoise::gyroscope_noise_density},
    {"gyroscope_random_walk", &scenario::ImuNoise::gyroscope_random_walk},
    {"accelerometer_noise_density", &scenario::ImuNoise::accelerometer_noise_density},
    {"accelerometer_random_walk", &scenario::ImuNoise::accelerometer_random_walk},
    {"gyroscope_turn_on_bias_radps", &scenario::ImuNoise::gyroscope_turn_on_bias_radps},
    {"accelerometer_turn_on_bias_mps2", &scenario::ImuNoise::accelerometer_turn_on_bias_mps2}};

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
