/// \file
/// An earlier run of a scenario, which takes the place of a simulation: it has the same corners,
/// signatures, motions and truth. A detector that needs no pictures finds the same as in a run of
/// its own, in a fraction of the time.
#pragma once

#include <filesystem>
#include <optional>

#include "scenarios/scenario.h"
#include "sim/pose.h"
#include "tools/bench/bench.h"
#include "tools/output/frame_pictures.h"

namespace lcs::bench {

class EarlierRun {
 public:
  /// \throws std::runtime_error naming the folder: it has no run, a broken one, or one of another
  ///   scenario, of another seed, or of the scenario as it was before its world changed.
  EarlierRun(const std::filesystem::path& folder, const scenario::Scenario& scenario,
             const Intrinsics& camera);

  /// The pictures of all frames, if the run kept them; else null.
  const FramePictures* pictures() const { return pictures_ ? &*pictures_ : nullptr; }

  /// Corners, signatures, motions and truth, without verdicts.
  const Recording& recording() const { return recorded_; }

  /// Whether there is a corner without a signature, as when the run had only a comparator: the
  /// filter then has less to go by than in a run of its own, and may decide otherwise.
  bool lacks_signatures() const;

  /// A recording of the scenario without frames yet.
  Recording begin() const;

  /// Goes through all frames, as `bench::run` does.
  /// \param with_images whether detector and sink get pictures, which needs `pictures()`: in colour
  ///   alone, and with the losses of their compression. Else they are empty.
  /// \return what was wrong with what the detector was told.
  /// \throws what the detector and the sink throw.
  Diagnostics run(Detector& detector, Recording& recording, bool with_images,
                  const FrameSink& sink) const;

 private:
  cv::Mat3b image(std::size_t position) const;

  Recording recorded_;  // without detections
  Intrinsics camera_;
  std::optional<FramePictures> pictures_;
};

}  // namespace lcs::bench
