/// \file
/// The steps of the study on recorded runs:
///
///     steps RUN...               # folders of runs that `lcs suite --keep all` has kept
///     steps --step N RUN...      # one step only
///     steps --rules NAME,...,NAME, RUN...    # these rules (rules.h), in place of those of a step
///
/// Prints a line of CSV for each run and step. `study.py` runs it and writes the table.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "tests/study/step_filter.h"
#include "tools/bench/bench.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/scoring.h"

namespace lcs::study {

/// Called after each step. Callgrind writes its counts after this name.
[[gnu::noinline]] void end_of_step() {
  asm volatile("");
}

namespace {

void score(const recording::Recording& seen, const std::string& run, std::string_view step,
           const Rules& rules) {
  StepDetector detector(seen.camera.value(), rules);
  scoring::Scorer scorer(seen);
  std::size_t corners = 0;
  for (recording::FrameRecord frame : seen.frames) {
    corners += frame.corners_px.size();
    bench::run_detector(detector, {}, {}, frame);
    scorer.add(frame);
  }
  const scoring::Metrics metrics = scorer.metrics(seen.warnings);
  std::string row = fmt::format("{},{},{}", run, step, corners);
  for (const char* name : {"rebel.f1", "rebel.precision", "rebel.recall",
                           "rebel.false_objects_per_100_frames", "dimension.mean"}) {
    const std::optional<double> value = scoring::value(metrics, name);
    row += value ? fmt::format(",{:.6g}", *value) : ",";
  }
  fmt::print("{}\n", row);
  end_of_step();
}

}  // namespace
}  // namespace lcs::study

int main(int argc, char** argv) {
  using namespace lcs::study;
  std::vector<std::string> words(argv + 1, argv + argc);
  try {
    std::vector<std::pair<std::string, Rules>> steps;
    if (words.size() > 2 && words[0] == "--step") {
      steps.emplace_back(words[1], rules_of(std::stoi(words[1])));
    } else if (words.size() > 2 && words[0] == "--rules") {
      steps.emplace_back("-1", rules_named(words[1]));
    } else {
      for (int k = 0; k <= kLastStep; ++k) steps.emplace_back(fmt::format("{}", k), rules_of(k));
    }
    if (steps.size() == 1) words.erase(words.begin(), words.begin() + 2);
    fmt::print("run,step,corners,f1,precision,recall,false_objects,items\n");
    for (const std::string& run : words) {
      const lcs::recording::Recording seen =
          lcs::recording::without_detections(lcs::recording::read_recording(run));
      for (const auto& [step, rules] : steps) score(seen, run, step, rules);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "steps: {}\n", error.what());
    return 2;
  }
}
