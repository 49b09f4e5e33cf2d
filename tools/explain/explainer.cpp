#include "tools/explain/explainer.h"

#include <fmt/format.h>

#include <stdexcept>

#include "tools/bench/bench.h"

namespace lcs::explain {
namespace {

/// Steps the filter, and requires that it judges the corners as stored.
void step(const recording::FrameRecord& frame, const std::filesystem::path& run,
          bench::LcsDetector& detector) {
  recording::FrameRecord again = recording::without_detections(frame);
  bench::run_detector(detector, {}, {}, again);
  if (again.verdicts == frame.verdicts && again.reasons == frame.reasons &&
      again.log_odds == frame.log_odds) {
    return;
  }
  throw std::runtime_error(
      fmt::format("{}: the verdicts in frame {} are not this filter's; another version or another "
                  "filter made the run, or it was edited: make it again",
                  run.string(), frame.index));
}

/// The camera as given to the filter, which is the only detector that can be explained.
Intrinsics camera_of(const recording::RunInfo& run, const AnyParameters& parameters,
                     const std::filesystem::path& folder) {
  if (run.detector.layered && run.camera && std::holds_alternative<Parameters>(parameters)) {
    return *run.camera;
  }
  throw std::runtime_error(folder.string() +
                           " is no run of the default filter with its camera, which alone can be "
                           "explained; run the scenario with --detector lcs:default");
}

}  // namespace

const std::filesystem::path& with_frames(const std::filesystem::path& run) {
  if (std::filesystem::exists(recording::stored(run, recording::kLayersFile))) return run;
  throw std::runtime_error(run.string() + " has no frames; name a run made with --keep all");
}

std::span<const Sighting> Explained::history(std::size_t corner) const {
  const std::optional<Explanation>& one = why.at(corner);
  return one ? tracks.at(one->track) : std::span<const Sighting>();
}

Explainer::Explainer(const std::filesystem::path& run, const AnyParameters& parameters)
    : run_(run),
      reader_(with_frames(run)),
      detector_(camera_of(reader_.run(), parameters, run), parameters) {
  const auto& plain = std::get<Parameters>(parameters);
  coast_frames_ = plain.edge.coast;
  said_.run = reader_.run();
  said_.field = plain.field;
}

bool Explainer::next() {
  recording::FrameRecord& frame = said_.frame;
  if (!reader_.next(frame)) return false;
  step(frame, run_, detector_);
  said_.outcomes = scorer_.add(frame).outcomes;
  said_.why.clear();
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    said_.why.push_back(detector_.filter().plain()->explain(static_cast<int>(i)));
    if (const auto& why = said_.why.back()) {
      said_.tracks[why->track].push_back({frame.index, frame.verdicts[i], frame.corner_truth[i],
                                          why->place_px(), why->miss_px(kStaticX),
                                          why->miss_px(kMovingX), why->seen[kLogOdds],
                                          why->seen[kBelief]});
    }
  }
  std::erase_if(said_.tracks, [&](const auto& track) {
    return track.second.back().frame + coast_frames_ < frame.index;  // it has ended
  });
  return true;
}

}  // namespace lcs::explain
