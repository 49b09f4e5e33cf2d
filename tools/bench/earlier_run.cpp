#include "tools/bench/earlier_run.h"

#include <fmt/format.h>

#include <stdexcept>
#include <utility>

#include "tools/recording/recording_io.h"

namespace lcs::bench {
namespace {

using WorldFacts = std::map<std::string, std::string>;

std::string as_written(const WorldFacts& world, const std::string& key) {
  const auto found = world.find(key);
  return found == world.end() ? fmt::format("no {}", key)
                              : fmt::format("{}: {}", key, found->second);
}

/// Describes the first difference.
std::string difference(const WorldFacts& then, const WorldFacts& now) {
  for (const WorldFacts* one : {&then, &now}) {
    for (const auto& [key, text] : *one) {
      const std::string before = as_written(then, key), after = as_written(now, key);
      if (before != after) return fmt::format("it has {}, and now there is {}", before, after);
    }
  }
  return "";
}

void require_same(const fs::path& folder, const recording::RunInfo& recorded, int frames,
                  const scenario::Scenario& scenario) {
  const auto refuse = [&](const std::string& what) {
    throw std::runtime_error(
        fmt::format("{} is no recording of this run: {}; run {} without --recorded to make one",
                    folder.string(), what, scenario.name));
  };
  if (recorded.scenario != scenario.name) refuse("it is of " + recorded.scenario);
  if (recorded.seed != scenario.seed) {
    refuse(fmt::format("it is of seed {}, not {}", recorded.seed, scenario.seed));
  }
  if (recorded.origin && scenario.origin && !recorded.origin->is_same_world(*scenario.origin)) {
    refuse(fmt::format("it is of the world {} {}, not {} {}", recorded.origin->family,
                       recorded.origin->seed, scenario.origin->family, scenario.origin->seed));
  }
  if (recorded.world.empty()) refuse("it does not say what world it is of");
  if (recorded.world != scenario.world) refuse(difference(recorded.world, scenario.world));
  // The run of a recording lacks frames whose pictures are unreadable.
  if (!scenario.recording && frames != scenario.frames) {
    refuse(fmt::format("it has {} frames of {}", frames, scenario.frames));
  }
}

}  // namespace

EarlierRun::EarlierRun(const fs::path& folder, const scenario::Scenario& scenario,
                       const Intrinsics& camera)
    : folder_(folder) {
  if (!fs::exists(recording::stored(folder, recording::kLayersFile))) {
    throw std::runtime_error(
        fmt::format("there is no run in {} with its frames; name a folder that was made with "
                    "--keep all, which is the default",
                    folder.string()));
  }
  recording::RecordingReader reader(folder);
  info_ = reader.run();
  info_.detector = {};
  frames_ = reader.count_left();
  if (frames_ != scenario.frames) {  // a file that is cut off is told by its name
    recording::RecordingReader both(folder);
    while (both.skip()) {
    }
  }
  require_same(folder, info_, frames_, scenario);
  if (!info_.origin) info_.origin = scenario.origin;
  const fs::path pictures = folder / output::kPicturesFile;
  if (!fs::exists(pictures)) return;
  pictures_.emplace(pictures, cv::Size(camera.width_px, camera.height_px));
  if (pictures_->size() != static_cast<std::size_t>(frames_)) {
    throw std::runtime_error(fmt::format("{} has {} pictures of {} frames; record the run again",
                                         pictures.string(), pictures_->size(), frames_));
  }
}

RunEnd EarlierRun::run(std::span<const DetectorRun> detectors, bool with_images, int threads) {
  recording::RecordingReader reader(folder_);
  std::size_t k = 0;
  const auto make = [&]() -> std::optional<InputFrame> {
    recording::FrameRecord recorded;
    if (!reader.next(recorded)) return std::nullopt;
    lacks_signatures_ |= recorded.signatures.size() < recorded.corners_px.size();
    lacks_gaps_ |= !recorded.gaps;
    return InputFrame{recording::without_detections(std::move(recorded)),
                      with_images ? pictures_.value().image(k++) : cv::Mat3b{},
                      {}};
  };
  const auto work = [&](const InputFrame& seen) {
    for (const DetectorRun& each : detectors) {
      recording::FrameRecord frame = seen.record;
      run_detector(each.detector, seen.image, {}, frame);
      each.sink(frame, seen.image);
    }
  };
  for_each_frame(make, work, threads);
  RunEnd end{.diagnostics = {}, .warnings = info_.warnings};
  for (const DetectorRun& each : detectors) {
    each.detector.finish();
    end.diagnostics.push_back(each.detector.diagnostics());
  }
  return end;
}

}  // namespace lcs::bench
