#include "tools/recording/detections.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/input/input_file.h"
#include "scenarios/input/message.h"
#include "tools/files/csv.h"
#include "tools/recording/coco_mask.h"
#include "tools/recording/recording_fields.h"

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

/// The image size; without a camera, the least size that holds the mask and all corners.
cv::Size size_for(const sim::Mask& mask, const FrameRecord& frame,
                  const std::optional<Intrinsics>& camera) {
  if (camera) return {camera->width_px, camera->height_px};
  cv::Size size(mask.box.x + mask.box.width, mask.box.y + mask.box.height);
  for (const Eigen::Vector2f& corner : frame.corners_px) {
    size.width = std::max(size.width, static_cast<int>(corner.x()) + 1);
    size.height = std::max(size.height, static_cast<int>(corner.y()) + 1);
  }
  return size;
}

std::string rows_of(const FrameRecord& frame, const std::optional<Intrinsics>& camera) {
  std::string rows;
  const int k = frame.index;
  for (std::size_t i = 0; i < frame.verdicts.size(); ++i) {
    if (frame.verdicts[i] == Verdict::normal) continue;
    rows += fmt::format("{},{},{}\n", k, kVerdicts[static_cast<std::size_t>(frame.verdicts[i])], i);
  }
  for (const Square& square : frame.layers.squares) {
    if (const auto mask = frame.masks.find(square.id); mask != frame.masks.end()) {
      const cv::Size size = size_for(mask->second, frame, camera);
      const sim::PixelRuns runs = sim::runs_in({{}, size}, mask->second);
      rows += fmt::format("{},mask,{},{},{},{}\n", k, square.id, size.height, size.width,
                          packed_runs(runs));
      continue;
    }
    rows += fmt::format("{},square,{},{},{},{},{}", k, square.id, square.location.x(),
                        square.location.y(), square.half_size.x(), square.half_size.y());
    for (const Vec2& vertex : square.outline.vertices()) {
      rows += fmt::format(",{},{}", vertex.x(), vertex.y());
    }
    rows += '\n';
  }
  for (const Circle& circle : frame.layers.rebel_circles) {
    rows += fmt::format("{},circle,{},{},{}\n", k, circle.location.x(), circle.location.y(),
                        circle.radius);
  }
  return rows;
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

DetectionsWriter::DetectionsWriter(const std::filesystem::path& csv, const RunInfo& run)
    : file_(csv), camera_(run.camera), states_circles_(run.detector.circles) {
  file_.write("frame,type\n");
}

void DetectionsWriter::write(const FrameRecord& frame) {
  if (states_circles_) file_.write(fmt::format("{},circle\n", frame.index));
  states_circles_ = false;
  file_.write(rows_of(frame, camera_));
}

}  // namespace lcs::recording
