/// \file
/// The figures of a set of filter parameters on recorded runs: a new filter processes the recorded
/// frames, and the result is scored like every run.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "filter/parameters.h"
#include "tools/recording/recording.h"

namespace lcs::tune {

/// Means over the runs, with equal weight for each run.
struct Worth {
  double f1 = 0;            ///< over the worlds with movers
  double false_moving = 0;  ///< false objects per frame, over these worlds
  double false_static = 0;  ///< false objects per frame, over the static worlds
  /// False objects per frame over all worlds, with at most 1 per frame for each world.
  double false_capped = 0;
  double false_corners = 0;  ///< false corners per frame, over static recordings

  /// The objective that `lcs tune` maximizes: F1 less 0.1 per false object per frame, less 0.01 per
  /// false corner per frame of recordings, which have more of them than worlds.
  double objective() const { return f1 - 0.1 * false_capped - 0.01 * false_corners; }
};

class Trials {
 public:
  /// Reads the runs of suites (`lcs suite`) of worlds or recordings.
  /// \param suites folders of suites, or their suite.json files.
  /// \throws std::runtime_error with the folder: no suite, a run without truth or signatures, a run
  ///   that changes while it is read, or a run of the split `test`, which must not be tuned on.
  explicit Trials(const std::vector<std::string>& suites);

  /// Uses all cores; the result does not depend on their number.
  /// \param tick called between two runs; an exception ends the work.
  Worth worth(
      const Parameters& parameters, const std::function<void()>& tick = [] {}) const;

  const std::vector<recording::Recording>& runs() const { return runs_; }

 private:
  void read(const std::filesystem::path& suite);

  std::vector<recording::Recording> runs_;
};

}  // namespace lcs::tune
