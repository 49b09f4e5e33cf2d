// Someone else's detections in CSV: read, and the same once more when written and read again; or
// refused by an error that names file and line.
#include "scenarios/scenario.h"
#include "tests/fuzz/input.h"
#include "tools/recording/detections.h"

namespace {

using namespace lcs;

/// Three frames of a few corners.
const bench::Recording& sequence() {
  static const bench::Recording recording = [] {
    bench::Recording made;
    made.scenario = "fuzz";
    for (int k = 0; k < 3; ++k) {
      bench::FrameRecord& frame = made.frames.emplace_back();
      frame.index = k;
      frame.t_ns = 100'000'000LL * k;
      for (int i = 0; i < 4; ++i) {
        frame.corners_px.emplace_back(10.F * static_cast<float>(i), 20.F + static_cast<float>(k));
        frame.verdicts.push_back(Verdict::normal);
      }
      frame.corner_truth.resize(frame.corners_px.size());
    }
    return made;
  }();
  return recording;
}

void check(const bench::Detections& detections) {
  fuzz::require(detections.recording.frames.size() == sequence().frames.size(),
                "no frame is lost or made");
  fuzz::require(detections.counts.corners() >= 0, "no more rows are left out than there are");
  for (const bench::FrameRecord& frame : detections.recording.frames) {
    fuzz::require(frame.verdicts.size() == frame.corners_px.size(), "each corner has a verdict");
    for (const Square& square : frame.layers.squares) {
      fuzz::require(square.location.allFinite() && square.half_size.minCoeff() > 0,
                    "boxes are boxes");
    }
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = fuzz::work_folder() / "detections.csv";
  fuzz::write_file(file, fuzz::text_of(data, size));
  try {
    const bench::Detections detections = bench::read_detections(file, sequence());
    check(detections);
    bench::write_detections(file, detections.recording);
    const bench::Detections again = bench::read_detections(file, sequence());
    for (std::size_t k = 0; k < sequence().frames.size(); ++k) {
      const bench::FrameRecord& a = detections.recording.frames[k];
      const bench::FrameRecord& b = again.recording.frames[k];
      fuzz::require(a.verdicts == b.verdicts, "verdicts survive writing and reading");
      fuzz::require(a.layers.squares.size() == b.layers.squares.size(), "and boxes do");
      fuzz::require(a.layers.rebel_circles.size() == b.layers.rebel_circles.size(), "and circles");
    }
  } catch (const scenario::Error& error) {
    fuzz::require(std::string_view(error.what()).find("detections.csv:") != std::string_view::npos,
                  "an error names file and line");
  }
  return 0;
}
