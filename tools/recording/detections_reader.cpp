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

namespace lcs::bench {
namespace {

class RowReader {
 public:
  explicit RowReader(Recording& recording) {
    for (FrameRecord& frame : recording.frames) {
      frames_.emplace(frame.index, FrameDetections(frame, recording.camera));
    }
  }

  /// \throws std::invalid_argument; the caller puts file and line before its message.
  void read(const std::vector<std::string_view>& row) {
    if (row.size() < 2) {
      throw std::invalid_argument("a row begins with FRAME,TYPE; there is one field");
    }
    frame_of(row[0]).add(row[1], std::span(row).subspan(2));
  }

  void finish(Detections& detections) {
    bool circles = false;
    for (auto& [index, frame] : frames_) {
      detections.counts += frame.finish();
      circles |= frame.gives_circles();
    }
    detections.recording.detector.circles = circles;
  }

 private:
  FrameDetections& frame_of(std::string_view text) {
    const std::optional<int> index = number_in<int>(text);
    if (!index) {
      throw std::invalid_argument(
          input::printable(fmt::format("the frame is '{}'; give its number", text)));
    }
    const auto found = frames_.find(*index);
    if (found != frames_.end()) return found->second;
    if (frames_.empty()) {
      throw std::invalid_argument(
          fmt::format("there is no frame {}: the sequence has none; leave its rows out", *index));
    }
    throw std::invalid_argument(
        fmt::format("there is no frame {}: the sequence has {} to {}; give one of these", *index,
                    frames_.begin()->first, frames_.rbegin()->first));
  }

  std::map<int, FrameDetections> frames_;
};

}  // namespace

Detections read_detections(const std::filesystem::path& csv, Recording sequence) {
  // A thousand rows for each of a million frames.
  constexpr input::FileKind kDetectionsTable{64 * input::kGibibyte,
                                             "name a CSV file of detections"};
  input::InputFile file(csv, kDetectionsTable);
  Detections detections;
  detections.recording = without_detections(std::move(sequence));
  detections.recording.detector = {.name = csv.stem().string(), .layered = false};
  RowReader reader(detections.recording);
  std::string line;
  bool header_may_come = true;
  while (file.next_line(line)) {
    const std::string_view text = trimmed(line);
    if (text.empty() || text.front() == '#') continue;
    const std::vector<std::string_view> row = fields_of(text);
    const bool is_header = header_may_come && row.front() == "frame";
    header_may_come = false;
    if (is_header) continue;
    try {
      reader.read(row);
    } catch (const std::invalid_argument& error) {
      throw input::Error(file.here(), error.what());
    }
  }
  reader.finish(detections);
  return detections;
}

}  // namespace lcs::bench
