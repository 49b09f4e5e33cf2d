#include "scenarios/imu_presets.h"

#include <array>
#include <utility>

namespace lcs::scenario {
namespace {

/// Noise density and random walk of the gyroscope, then of the accelerometer.
constexpr std::array<std::pair<std::string_view, ImuNoise>, 4> presets{{
    {"adis16448", {1.6968e-4, 1.9393e-5, 2.0e-3, 3.0e-3}},
    {"tumvi", {1.6e-4, 2.2e-5, 2.8e-3, 8.6e-4}},
    {"esim", {1.86e-4, 2.66e-5, 1.86e-3, 4.33e-4}},
    {"ideal", {}},
}};

}  // namespace

std::vector<std::string> imu_preset_names() {
  std::vector<std::string> names;
  for (const auto& [name, noise] : presets) names.emplace_back(name);
  return names;
}

std::optional<ImuNoise> imu_preset(std::string_view name) {
  for (const auto& [known, noise] : presets) {
    if (known == name) return noise;
  }
  return std::nullopt;
}

}  // namespace lcs::scenario
