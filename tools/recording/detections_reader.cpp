#include <fmt/format.h>

#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/input/input_file.h"
#include "scenarios/input/message.h"
#include "tools/files/csv.h"
#include "tools/recording/detections.h"

namespace lcs::recording {
namespace {

using Frames = std::map<int, FrameDetections>;  ///< by index

/// \throws std::invalid_argument; the caller puts file and line before its message.
FrameDetections& frame_of(std::string_view text, Frames& frames) {
  const std::optional<int> index = files::number_in<int>(text);
  if (!index) {
    throw std::invalid_argument(
        input::printable(fmt::format("the frame is '{}'; give its number", text)));
  }
  const auto found = frames.find(*index);
  if (found != frames.end()) return found->second;
  if (frames.empty()) {
    throw std::invalid_argument(
        fmt::format("there is no frame {}: the sequence has none; leave its rows out", *index));
  }
  throw std::invalid_argument(
      fmt::format("there is no frame {}: the sequence has {} to {}; give one of these", *index,
                  frames.begin()->first, frames.rbegin()->first));
}

}  // namespace

Detections read_detections(const std::filesystem::path& csv, Recording sequence) {
  // A thousand rows for each of a million frames.
  constexpr input::FileKind kDetectionsTable{64 * input::kGibibyte,
                                             "name a CSV file of detections"};
  input::InputFile file(csv, kDetectionsTable);
  Detections detections;
  detections.recording = without_detections(std::move(sequence));
  detections.recording.detector = {.name = csv.stem().string(), .layered = false};
  Frames frames;
  for (FrameRecord& frame : detections.recording.frames) {
    frames.emplace(frame.index, FrameDetections(frame, detections.recording.camera));
  }
  std::string line;
  bool header_may_come = true;
  while (file.next_line(line)) {
    const std::string_view text = files::trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    const std::vector<std::string_view> row = files::fields_of(text);
    const bool is_header = header_may_come && row.front() == "frame";
    header_may_come = false;
    if (is_header) continue;
    try {
      if (row.size() < 2) {
        throw std::invalid_argument("a row begins with FRAME,TYPE; there is one field");
      }
      frame_of(row[0], frames).add(row[1], std::span(row).subspan(2));
    } catch (const std::invalid_argument& error) {
      throw input::Error(file.here(), error.what());
    }
  }
  bool circles = false;
  for (auto& [index, frame] : frames) {
    detections.counts += frame.finish();
    circles |= frame.gives_circles();
  }
  detections.recording.detector.circles = circles;
  return detections;
}

}  // namespace lcs::recording
