#include "scenarios/imu_presets.h"

#include <array>
#include <ranges>
#include <utility>

namespace lcs::scenario {
namespace {

constexpr std::array presets = {
    std::pair{std::string_view("adis16448"), ImuNoise{.gyroscope_noise_density = 1.6968e-4,
                                                      .gyroscope_random_walk = 1.9393e-5,
                                                      .accelerometer_noise_density = 2.0e-3,
                                                      .accelerometer_random_walk = 3.0e-3}},
    std::pair{std::string_view("tumvi"), ImuNoise{.gyroscope_noise_density = 1.6e-4,
                                                  .gyroscope_random_walk = 2.2e-5,
                                                  .accelerometer_noise_density = 2.8e-3,
                                                  .accelerometer_random_walk = 8.6e-4}},
    std::pair{std::string_view("esim"), ImuNoise{.gyroscope_noise_density = 1.86e-4,
                                                 .gyroscope_random_walk = 2.66e-5,
                                                 .accelerometer_noise_density = 1.86e-3,
                                                 .accelerometer_random_walk = 4.33e-4}},
    std::pair{std::string_view("ideal"), ImuNoise{}},
};

}  // namespace

std::vector<std::string> imu_preset_names() {
  const auto names = presets | std::views::keys;
  return {names.begin(), names.end()};
}

std::optional<ImuNoise> imu_preset(std::string_view name) {
  for (const auto& [known, noise] : presets) {
    if (known == name) return noise;
  }
  return std::nullopt;
}

}  // namespace lcs::scenario
