#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string>

#include "tools/recording/coco_mask.h"
#include "tools/recording/detections.h"
#include "tools/recording/recording_fields.h"

namespace lcs::recording {
namespace {

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
