/// \file
/// The steps of the study on recorded runs:
///
///     steps RUN...               # folders of runs that `lcs suite --keep all` has kept
///     steps --count STEP RUN     # one step only: for callgrind, which counts its instructions
///
/// Prints a line of CSV for each run and step. `study.py` runs it and writes the table.
#include <fmt/format.h>

#include <cstdio>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

#include "tests/study/step_filter.h"
#include "tools/bench/bench.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/scoring.h"

namespace lcs::study {
namespace {

/// A frame of a step. Its instructions are counted, by this name.
[[gnu::noinline]] void counted_frame(StepDetector& detector, recording::FrameRecord& frame) {
  bench::run_detector(detector, {}, {}, frame);
}

void score(const recording::Recording& seen, const std::string& run, int step) {
  StepDetector detector(seen.camera.value(), step);
  scoring::Scorer scorer(seen);
  std::size_t corners = 0;
  for (recording::FrameRecord frame : seen.frames) {
    corners += frame.corners_px.size();
    counted_frame(detector, frame);
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
}

}  // namespace
}  // namespace lcs::study

int main(int argc, char** argv) {
  std::vector<std::string> words(argv + 1, argv + argc);
  int first = 0, last = lcs::study::kLastStep;
  try {
    if (words.size() == 3 && words[0] == "--count") {
      first = last = std::stoi(words[1]);
      words.erase(words.begin(), words.begin() + 2);
    }
    fmt::print("run,step,corners,f1,precision,recall,false_objects,items\n");
    for (const std::string& run : words) {
      const lcs::recording::Recording seen =
          lcs::recording::without_detections(lcs::recording::read_recording(run));
      for (int step = first; step <= last; ++step) lcs::study::score(seen, run, step);
    }
  } catch (const std::exception& error) {
    fmt::print(stderr, "steps: {}\n", error.what());
    return 2;
  }
}
