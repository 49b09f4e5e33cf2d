/// \file
/// Noise parameters of known IMUs, in Kalibr's units. Sources: the calibration files of EuRoC MAV
/// (ADIS16448) and TUM-VI (BMI160), and the defaults of the simulator ESIM.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::scenario {

/// "adis16448", "tumvi", "esim", and the noise-free "ideal".
std::vector<std::string> imu_preset_names();

/// The noise of a preset; absent for an unknown name.
std::optional<ImuNoise> imu_preset(std::string_view name);

}  // namespace lcs::scenario
