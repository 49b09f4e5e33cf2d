// Optical flow in KITTI's 16-bit PNG and Middlebury's .flo: the full motion, and the camera's part
// of it.
#include <fmt/format.h>

#include <algorithm>
#include <bit>

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
  std::transform(motion_px.begin(), motion_px.end(), valid.begin(), code.begin(), kitti_code);
  return code;
}

std::string middlebury_flow(const cv::Mat2f& motion_px) {
  static_assert(std::endian::native == std::endian::little, "the format is little-endian");
  constexpr float kTag = 202021.25F;
  const std::int32_t size[2] = {motion_px.cols, motion_px.rows};
  cv::Mat2f known = motion_px.clone();
  cv::patchNaNs(known, kMiddleburyUnknown);
  std::string bytes;
  bytes.reserve(sizeof kTag + sizeof size + known.total() * known.elemSize());
  bytes.append(reinterpret_cast<const char*>(&kTag), sizeof kTag);
  bytes.append(reinterpret_cast<const char*>(size), sizeof size);
  bytes.append(reinterpret_cast<const char*>(known.data), known.total() * known.elemSize());
  return bytes;
}

const MakeWriter make_flow_writer = make_writer<FlowWriter>;

}  // namespace lcs::sequence
