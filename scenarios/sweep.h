/// \file
/// A sweep: one scenario at each point of a grid of values.
///
///     sweep:
///       ego.speed: [0.2 m/s, 0.4 m/s]   # any key that `--set` takes
///       camera.rate: [5 Hz, 10 Hz]      # the last key varies fastest
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace lcs::scenario {

/// Its scenario is the file loaded with "key=value" of each setting as `LoadOptions::sets`.
struct SweepPoint {
  std::vector<std::pair<std::string, std::string>> settings;  ///< key, value as YAML text
};

/// The grid in order; one point without settings if the scenario has no sweep. Each point is loaded
/// once for a check, so that no point fails later.
/// \throws Error at the line of a value that its key rejects.
std::vector<SweepPoint> sweep_points(const std::filesystem::path& file);

}  // namespace lcs::scenario
