/// \file
/// An earlier run of a scenario replaces a simulation: same corners, signatures, motions and truth.
/// A detector that needs no pictures gives the same results as in a run of its own, much faster.
#pragma once

#include <filesystem>
#include <optional>
#include <span>

#include "scenarios/scenario.h"
#include "tools/bench/bench.h"
#include "tools/output/frame_pictures.h"

namespace lcs::bench {

class EarlierRun {
 public:
  /// \throws std::runtime_error naming the folder, if it has no valid run, or a run of another
  ///   scenario, seed or world.
  EarlierRun(const std::filesystem::path& folder, const scenario::Scenario& scenario,
             const Intrinsics& camera);

  /// The pictures of all frames, if the run kept them; else null.
  const output::FramePictures* pictures() const { return pictures_ ? &*pictures_ : nullptr; }

  /// The scenario, seed, world, objects and truth of the run, without its detector.
  const recording::RunInfo& info() const { return info_; }
  int frames() const { return frames_; }

  /// Whether, as `run` has found, some corner has no signature, as in a run with only a comparator.
  /// The filter may then decide differently from a run of its own.
  bool lacks_signatures() const { return lacks_signatures_; }

  /// Whether, as `run` has found, the run did not look at gaps below circles, as one with only a
  /// comparator. The filter then finds no bodies that approach at constant speed.
  bool lacks_gaps() const { return lacks_gaps_; }

  /// Processes all frames like `bench::run`.
  /// \param with_images whether detector and sink get pictures; needs `pictures()`. Only colour,
  ///   with losses of compression. Else the pictures are empty.
  /// \param threads as of `bench::run`.
  /// \throws the exceptions of the detectors and the sinks; std::runtime_error for a damaged file.
  RunEnd run(std::span<const DetectorRun> detectors, bool with_images, int threads = 1);

 private:
  std::filesystem::path folder_;
  recording::RunInfo info_;
  int frames_ = 0;
  bool lacks_signatures_ = false, lacks_gaps_ = false;
  std::optional<output::FramePictures> pictures_;
};

}  // namespace lcs::bench
