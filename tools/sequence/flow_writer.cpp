// Optical flow in KITTI's 16-bit PNG and Middlebury's .flo: the full motion, and the camera's part
// of it.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <vector>

#include "tools/sequence/flow_code.h"
#include "tools/sequence/png.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

class FlowWriter : public Writer {
 public:
  using Writer::Writer;

  void write(const FrameView& frame, FrameOutput& output) const override {
    if (frame.motion == nullptr) return;  // the last frame has no successor
    const int k = frame.now.index;
    const auto add = [&](const char* kind, const cv::Mat2f& motion, const cv::Mat1b& seen) {
      output.files.push_back({fmt::format("{}/kitti/{:06}.png", kind, k),
                              encode_png(kitti_flow(motion, seen), PngFilter::sub), ""});
      output.files.push_back(
          {fmt::format("{}/middlebury/{:06}.flo", kind, k), middlebury_flow(motion), ""});
    };
    add("flow", frame.motion->full_px, frame.motion->seen);
    add("flow_ego", frame.motion->ego_px, frame.motion->ego_seen);
  }
};

}  // namespace

cv::Mat3w kitti_flow(const cv::Mat2f& motion_px, const cv::Mat1b& valid) {
  cv::Mat3w code(motion_px.size());
  for (int y = 0; y < code.rows; ++y) {
    const cv::Vec2f* from = motion_px[y];
    const unsigned char* is_valid = valid[y];
    cv::Vec3w* to = code[y];
    for (int x = 0; x < code.cols; ++x) to[x] = kitti_code(from[x], is_valid[x] != 0);
  }
  return code;
}

std::string middlebury_flow(const cv::Mat2f& motion_px) {
  static_assert(std::endian::native == std::endian::little, "the format is little-endian");
  constexpr float kTag = 202021.25F;
  const std::int32_t size[2] = {motion_px.cols, motion_px.rows};
  const std::size_t row_bytes = static_cast<std::size_t>(motion_px.cols) * sizeof(cv::Vec2f);
  std::string bytes;
  bytes.reserve(sizeof kTag + sizeof size + row_bytes * static_cast<std::size_t>(motion_px.rows));
  bytes.append(reinterpret_cast<const char*>(&kTag), sizeof kTag);
  bytes.append(reinterpret_cast<const char*>(size), sizeof size);
  std::vector<float> row(2 * static_cast<std::size_t>(motion_px.cols));
  for (int y = 0; y < motion_px.rows; ++y) {
    const auto* values = motion_px.ptr<float>(y);
    std::replace_copy_if(
        values, values + row.size(), row.begin(), [](float value) { return std::isnan(value); },
        kMiddleburyUnknown);
    bytes.append(reinterpret_cast<const char*>(row.data()), row_bytes);
  }
  return bytes;
}

std::unique_ptr<Writer> make_flow_writer(const SequenceInfo& info) {
  return std::make_unique<FlowWriter>(info);
}

}  // namespace lcs::sequence
