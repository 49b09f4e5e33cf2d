/// \file
/// Noise parameters of known IMUs, in Kalibr's units. Sources: the calibration files of EuRoC MAV
/// (ADIS16448) and TUM-VI (BMI160), and the defaults of the simulator ESIM.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::scenario {

/// Noise density and random walk of the gyroscope, then of the accelerometer.
inline constexpr std::array<std::pair<std::string_view, ImuNoise>, 4> kImuPresets{{
    {"adis16448", {1.6968e-4, 1.9393e-5, 2.0e-3, 3.0e-3}},
    {"tumvi", {1.6e-4, 2.2e-5, 2.8e-3, 8.6e-4}},
    {"esim", {1.86e-4, 2.66e-5, 1.86e-3, 4.33e-4}},
    {"ideal", {}},
}};

inline std::vector<std::string> imu_preset_names() {
  std::vector<std::string> names;
  for (const auto& [name, noise] : kImuPresets) names.emplace_back(name);
  return names;
}

/// The noise of a preset; absent for an unknown name.
inline std::optional<ImuNoise> imu_preset(std::string_view name) {
  for (const auto& [known, noise] : kImuPresets) {
    if (known == name) return noise;
  }
  return std::nullopt;
}

}  // namespace lcs::scenario
