// Foreign detections in CSV, with known and with unknown camera: read, and unchanged after writing
// and reading again; or refused by an error that names file and line.
#include "scenarios/scenario.h"
#include "tests/fuzz/input.h"
#include "tests/scoring/whole_recordings.h"
#include "tools/recording/box.h"
#include "tools/recording/detections.h"

namespace {

using namespace lcs;

constexpr int kWidth_px = 64, kHeight_px = 48;

/// Three frames of a few corners.
const recording::Recording& sequence(bool has_camera) {
  static const auto make = [](bool is_known) {
    recording::Recording made;
    if (is_known) made.camera = Intrinsics{50, {31.5, 23.5}, kWidth_px, kHeight_px};
    made.scenario = "fuzz";
    for (int k = 0; k < 3; ++k) {
      recording::FrameRecord& frame = made.frames.emplace_back();
      frame.index = k;
      frame.t_ns = 100'000'000LL * k;
      for (int i = 0; i < 4; ++i) {
        frame.corners_px.emplace_back(10.F * static_cast<float>(i), 20.F + static_cast<float>(k));
        frame.verdicts.push_back(Verdict::normal);
      }
      frame.corner_truth.resize(frame.corners_px.size());
    }
    return made;
  };
  static const recording::Recording without = make(false), with = make(true);
  return has_camera ? with : without;
}

void check(const recording::Detections& detections) {
  fuzz::require(detections.recording.frames.size() == sequence(true).frames.size(),
                "no frame is lost or made");
  fuzz::require(detections.counts.corners() >= 0, "no more rows are left out than there are");
  for (const recording::FrameRecord& frame : detections.recording.frames) {
    fuzz::require(frame.verdicts.size() == frame.corners_px.size(), "each corner has a verdict");
    for (const Square& square : frame.layers.squares) {
      fuzz::require(square.location.allFinite() && square.half_size.minCoeff() >= 0,
                    "boxes are boxes");
    }
    if (!detections.recording.camera) continue;
    const cv::Rect picture(0, 0, kWidth_px, kHeight_px);
    for (const auto& [id, mask] : frame.masks) {
      fuzz::require((mask.box & picture) == mask.box, "masks lie in the picture");
    }
    for (const Square& square : frame.layers.squares) {
      const auto edges = recording::edges_of(square);
      fuzz::require(edges[0] <= kWidth_px + 1 && edges[1] <= kHeight_px + 1 && edges[2] >= -1 &&
                        edges[3] >= -1,
                    "boxes touch the picture");
    }
  }
}

/// Read, written and read again, or refused.
void read(const std::filesystem::path& file, const recording::Recording& recording) {
  try {
    const recording::Detections detections = recording::read_detections(file, recording);
    check(detections);
    const std::filesystem::path copy = fuzz::work_folder() / "again.csv";
    scoring::write_detections(copy, detections.recording);
    const recording::Detections again = recording::read_detections(copy, recording);
    for (std::size_t k = 0; k < recording.frames.size(); ++k) {
      const recording::FrameRecord& a = detections.recording.frames[k];
      const recording::FrameRecord& b = again.recording.frames[k];
      fuzz::require(a.verdicts == b.verdicts, "verdicts survive writing and reading");
      fuzz::require(a.layers.squares.size() == b.layers.squares.size(), "and boxes do");
      fuzz::require(a.layers.rebel_circles.size() == b.layers.rebel_circles.size(), "and circles");
    }
  } catch (const input::Error& error) {
    fuzz::require(std::string_view(error.what()).find("detections.csv:") != std::string_view::npos,
                  "an error names file and line");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::filesystem::path file = fuzz::work_folder() / "detections.csv";
  fuzz::write_file(file, fuzz::text_of(data, size));
  for (const bool has_camera : {false, true}) read(file, sequence(has_camera));
  return 0;
}
