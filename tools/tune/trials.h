/// \file
/// What a set of the filter's parameters is worth on recorded runs: frames as they were seen, asked
/// of a new filter, and scored as every run is.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "filter/parameters.h"
#include "tools/recording/recording.h"

namespace lcs::tune {

/// Means over the runs, each counted once.
struct Worth {
  double f1 = 0;            ///< over the worlds in which something moves
  double false_moving = 0;  ///< false objects in a frame: of these,
  double false_static = 0;  ///< and of those in which nothing moves
  /// The same over all worlds, where none counts for more than one a frame.
  double false_capped = 0;
  double false_corners = 0;  ///< in a frame: of recordings in which nothing moves

  /// What `lcs tune` makes the most of: F1, less a tenth of a false object a frame, or of ten false
  /// corners in recordings, which have more of them than worlds.
  double objective() const { return f1 - 0.1 * false_capped - 0.01 * false_corners; }
};

class Trials {
 public:
  /// Reads the runs of suites (`lcs suite`), of worlds or recordings.
  /// \param suites folders of suites, or their files.
  /// \throws std::runtime_error naming the folder: no suite, a run without truth or signatures, one
  ///   that changes while it is read, or one of the split `test`, by which nothing is chosen.
  explicit Trials(const std::vector<std::string>& suites);

  /// On all cores; the same on any number of them.
  /// \param tick called between two runs; what it throws ends the work.
  Worth worth(
      const Parameters& parameters, const std::function<void()>& tick = [] {}) const;

  const std::vector<bench::Recording>& runs() const { return runs_; }

  /// SHA-256 of all files that the runs were read from.
  const std::string& digest() const { return digest_; }

 private:
  void read(const std::filesystem::path& suite);

  std::vector<bench::Recording> runs_;
  std::string digest_;
};

}  // namespace lcs::tune
