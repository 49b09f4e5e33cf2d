// Optical flow: KITTI's 16-bit PNG and Middlebury's .flo, of the whole motion and of the camera's
// own part of it.
#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <cstring>

#include "tools/sequence/flow_code.h"
#include "tools/sequence/png.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

class FlowWriter : public Writer {
 public:
  void write(const FrameView& frame, FrameOutput& output) const override {
    if (frame.motion == nullptr) return;  // nothing follows the last frame
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
  std::vector<Document> documents() const override { return {}; }
};

}  // namespace

cv::Mat3w kitti_flow(const cv::Mat2f& motion_px, const cv::Mat1b& valid) {
  cv::Mat3w code(motion_px.size());
  for (int y = 0; y < code.rows; ++y) {
    const cv::Vec2f* from = motion_px[y];
    const unsigned char* is_valid = valid[y];
    cv::Vec3w* to = code[y];
    for (int x = 0; x < code.cols; ++x) {
      // In double: a float of 16 whole bits has too few left for the rounding.
      const double u = static_cast<double>(from[x][0]) * kKittiFlowScale + kKittiFlowZero;
      const double v = static_cast<double>(from[x][1]) * kKittiFlowScale + kKittiFlowZero;
      constexpr double kMost = 65535;
      const bool fits = u >= 0 && u <= kMost && v >= 0 && v <= kMost;  // not so a NaN
      if (is_valid[x] && fits) {
        // Positive, so that adding a half rounds to the nearest.
        to[x] = {static_cast<std::uint16_t>(u + 0.5), static_cast<std::uint16_t>(v + 0.5), 1};
      } else {
        to[x] = {0, 0, 0};
      }
    }
  }
  return code;
}

std::string middlebury_flow(const cv::Mat2f& motion_px) {
  static_assert(std::endian::native == std::endian::little, "the format is little-endian");
  constexpr float kTag = 202021.25F;
  const std::int32_t size[2] = {motion_px.cols, motion_px.rows};
  const std::size_t row_bytes = static_cast<std::size_t>(motion_px.cols) * sizeof(cv::Vec2f);
  std::string bytes(
      sizeof kTag + sizeof size + row_bytes * static_cast<std::size_t>(motion_px.rows), '\0');
  std::memcpy(bytes.data(), &kTag, sizeof kTag);
  std::memcpy(bytes.data() + sizeof kTag, size, sizeof size);
  char* to = bytes.data() + sizeof kTag + sizeof size;
  for (int y = 0; y < motion_px.rows; ++y, to += row_bytes) {
    std::memcpy(to, motion_px[y], row_bytes);
    auto* values = reinterpret_cast<float*>(to);
    for (int i = 0; i < 2 * motion_px.cols; ++i) {
      if (std::isnan(values[i])) values[i] = kMiddleburyUnknown;
    }
  }
  return bytes;
}

std::unique_ptr<Writer> make_flow_writer(const SequenceInfo&) {
  return std::make_unique<FlowWriter>();
}

}  // namespace lcs::sequence
