/// \file
/// `lcs.json` of a generated sequence: the additional inputs with which a replay reproduces the
/// bits of the run. They are the detector settings, and the mounting and the start in the rover's
/// own frame. `sensor.yaml` and the truth have the same poses, but only as products of rounded
/// matrices.
#pragma once

#include <cstdint>
#include <filesystem>
#include <string>
#include <utility>

#include "scenarios/scenario.h"
#include "sim/simulation.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {

inline constexpr const char* kSettingsFile = "lcs.json";
/// The truth that scores a replay (`replay::read_seen`), with the times in the pictures' names.
inline constexpr const char* kTruthFile = "truth.jsonl";

/// The keys of IMU noise, here and (if Kalibr has them) in `sensor.yaml`.
inline constexpr std::pair<const char*, double scenario::ImuNoise::*> kImuNoise[] = {
    {"gyroscope_noise_density", &scenario::ImuNoise::gyroscope_noise_density},
    {"gyroscope_random_walk", &scenario::ImuNoise::gyroscope_random_walk},
    {"accelerometer_noise_density", &scenario::ImuNoise::accelerometer_noise_density},
    {"accelerometer_random_walk", &scenario::ImuNoise::accelerometer_random_walk},
    {"gyroscope_turn_on_bias_radps", &scenario::ImuNoise::gyroscope_turn_on_bias_radps},
    {"accelerometer_turn_on_bias_mps2", &scenario::ImuNoise::accelerometer_turn_on_bias_mps2}};

struct ReplaySettings {
  /// Name, origin, seed, rates, noise, odometry, detection and filter of the scenario; the rest has
  /// default values.
  scenario::Scenario scenario;
  sim::Calibration calibration;  ///< without optics and camera
  sim::Lens lens;                ///< of the pictures
  /// Of a rig: cam0, cam1 and so on; `lens` and the calibration belong to camera `filter_place`.
  struct Camera {
    std::string name;  ///< in the scenario
    sim::Lens lens;
    sim::Pose T_BC;
  };
  std::vector<Camera> cameras;
  std::size_t filter_place = 0;
  std::int64_t start_ns = 0;  ///< the run's time 0, in the sequence's time
};

/// \param info of the camera that detectors get.
std::string settings_text(const SequenceInfo& info);

/// \throws std::runtime_error with file and key.
ReplaySettings read_settings(const std::filesystem::path& file);

}  // namespace lcs::sequence
