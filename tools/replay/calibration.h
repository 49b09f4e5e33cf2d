/// \file
/// `sensor.yaml` in EuRoC's ASL format, with Kalibr's keys.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "scenarios/scenario.h"
#include "sim/pose.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

struct SensorYaml {
  sim::Pose T_BS;
  std::optional<double> rate_hz;
  std::optional<Lens> lens;                        ///< of a camera
  std::optional<scenario::ImuNoise> noise;         ///< of an IMU; turn-on biases are 0
  std::map<std::string, input::Source> keys = {};  ///< top-level keys and their places
};

/// \throws input::Error with file and line.
SensorYaml read_sensor_yaml(const std::filesystem::path& file);

}  // namespace lcs::replay
