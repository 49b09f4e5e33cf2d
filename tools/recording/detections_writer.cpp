#include <fmt/format.h>

#include <string>

#include "tools/recording/detections.h"
#include "tools/recording/recording_fields.h"

namespace lcs::bench {
namespace {

std::string rows_of(const FrameRecord& frame) {
  std::string rows;
  const int k = frame.index;
  for (std::size_t i = 0; i < frame.verdicts.size(); ++i) {
    if (frame.verdicts[i] == Verdict::normal) continue;
    rows += fmt::format("{},{},{}\n", k, kVerdicts[static_cast<std::size_t>(frame.verdicts[i])], i);
  }
  for (const Square& square : frame.layers.squares) {
    rows += fmt::format("{},square,{},{},{},{},{}\n", k, square.id, square.location.x(),
                        square.location.y(), square.half_size.x(), square.half_size.y());
  }
  for (const Circle& circle : frame.layers.rebel_circles) {
    rows += fmt::format("{},circle,{},{},{}\n", k, circle.location.x(), circle.location.y(),
                        circle.radius);
  }
  return rows;
}

}  // namespace

void write_detections(const std::filesystem::path& csv, const Recording& recording) {
  OutputFile file(csv);
  file.write(fmt::format("{}\n", kDetectionsHeader));
  if (recording.detector.circles && !recording.frames.empty()) {
    file.write(fmt::format("{},circle\n", recording.frames.front().index));  // should there be none
  }
  for (const FrameRecord& frame : recording.frames) file.write(rows_of(frame));
  file.close();
}

}  // namespace lcs::bench
