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

/// A scenario at `settings` is the file loaded with "key=value" of each as `LoadOptions::sets`.
struct SweepPoint {
  std::vector<std::pair<std::string, std::string>> settings;  ///< key, value as YAML text
};

/// The grid in order; one point without settings for a scenario that sweeps nothing. Each point has
/// been loaded once, so that none of them is refused later.
/// \throws Error at the line of the value that its key does not take.
std::vector<SweepPoint> sweep_points(const std::filesystem::path& file);

}  // namespace lcs::scenario
