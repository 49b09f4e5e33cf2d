#include "tools/tune/search.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "filter/filter.h"
#include "scenes/worlds/worlds.h"
#include "tools/process/parallel.h"
#include "tools/recording/recording_io.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/metrics.h"
#include "tools/scoring/scoring.h"
#include "tools/suite/suite_result.h"

namespace lcs::tune {
namespace {

/// The figures of a new filter with these parameters on the frames of the run.
scoring::Metrics figures_of(const recording::Recording& seen, const Parameters& parameters) {
  Filter filter(seen.camera.value(), parameters);
  scoring::Scorer scorer(seen);
  for (recording::FrameRecord frame : seen.frames) {
    const FrameResult& result = filter.step(frame.corners_px, frame.signatures, frame.motion);
    frame.verdicts = result.verdicts;
    // The figures of `Worth` do not depend on edges and squares.
    frame.layers.rebel_circles = result.layers.rebel_circles;
    scorer.add(frame);
  }
  return scorer.metrics(seen.warnings);
}

/// The evidence that a run is of the split `test`; "" if there is none.
std::string why_of_test(const suite::ScenarioResult& scenario, const recording::RunInfo& run) {
  const worlds::Split& test = worlds::split("test");
  const auto is_of_test = [&](std::uint64_t seed) {
    return seed >= test.first_seed && seed <= test.last_seed;
  };
  if (std::ranges::count(scenario.groups, test.name) > 0) return "by its group";
  const auto origin = run.origin ? run.origin : worlds::origin_named(run.scenario);
  if (origin && is_of_test(origin->seed)) {
    return fmt::format("world {} {}", origin->family, origin->seed);
  }
  return is_of_test(run.seed) ? fmt::format("by its seed {}", run.seed) : "";
}

}  // namespace

Trials::Trials(const std::vector<std::string>& suites) {
  for (const std::string& suite : suites) read(suite);
  if (runs_.empty()) throw std::runtime_error("the suites have no run; name others");
  // Longest first, so that all cores finish at about the same time.
  std::ranges::stable_sort(runs_, std::greater(), [](const recording::Recording& run) {
    std::size_t corners = 0;
    for (const recording::FrameRecord& frame : run.frames) corners += frame.corners_px.size();
    return corners;
  });
}

void Trials::read(const std::filesystem::path& suite) {
  for (const suite::ScenarioResult& scenario : suite::read_suite(suite).scenarios) {
    for (const suite::RunResult& run : scenario.runs) {
      if (run.folder.empty()) {
        throw std::runtime_error(fmt::format(
            "{} has no figures of {}, seed {}; correct it, or leave it out of the suite",
            suite.string(), scenario.name, run.seed));
      }
      const std::filesystem::path folder = suite::folder_of(suite) / run.folder;
      const auto refuse = [&](const std::string& why) {
        throw std::runtime_error(fmt::format("{} {}", folder.string(), why));
      };
      recording::Recording recording =
          recording::without_detections(recording::read_recording(folder));
      if (const std::string why = why_of_test(scenario, recording); !why.empty()) {
        refuse(fmt::format(
            "is of the split test ({}), by which nothing is chosen; name a suite of train", why));
      }
      if (recording.truth == recording::Truth::unknown) refuse("has no truth to learn from");
      if (!recording.camera) refuse("does not say what camera it was; run it again");
      runs_.push_back(std::move(recording));
    }
  }
}

Worth Trials::worth(const Parameters& parameters, const std::function<void()>& tick) const {
  std::vector<scoring::Metrics> figures(runs_.size());
  process::for_each_parallel(
      static_cast<int>(runs_.size()), [&](int i) { figures[i] = figures_of(runs_[i], parameters); },
      [&](int) { tick(); });
  Worth worth;
  double moving = 0, still = 0, recorded = 0;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const auto figure = [&](std::string_view name) { return scoring::value(figures[i], name); };
    if (runs_[i].truth == recording::Truth::nothing_moves) {
      worth.false_corners += figure("rebel.false_corners_per_frame").value_or(0);
      ++recorded;
      continue;
    }
    const double off = figure("rebel.false_objects_per_100_frames").value_or(0) / 100;
    worth.false_capped += std::min(1.0, off);
    if (const auto f1 = figure(scoring::kF1)) {
      worth.f1 += *f1;
      worth.false_moving += off;
      ++moving;
    } else {
      worth.false_static += off;
      ++still;
    }
  }
  if (moving > 0) worth.f1 /= moving, worth.false_moving /= moving;
  if (still > 0) worth.false_static /= still;
  if (moving + still > 0) worth.false_capped /= moving + still;
  if (recorded > 0) worth.false_corners /= recorded;
  return worth;
}

}  // namespace lcs::tune
