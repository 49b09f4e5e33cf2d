// A value for each pixel: optical flow and depth.
#include <fmt/format.h>

#include <algorithm>
#include <bit>

#include "tools/sequence/flow_code.h"
#include "tools/sequence/png.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

/// Middlebury's code for unknown flow: any value beyond 1e9.
constexpr float kMiddleburyUnknown = 1e10F;

/// The motion of each pixel in KITTI's encoding.
cv::Mat3w kitti_flow(const cv::Mat2f& motion_px, const cv::Mat1b& valid) {
  cv::Mat3w code(motion_px.size());
  std::transform(motion_px.begin(), motion_px.end(), valid.begin(), code.begin(), kitti_code);
  return code;
}

/// \return the bytes of a .flo file.
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

/// Rounds to the nearest 1/256 m; 0 means no depth: the sky, and anything beyond 255.99 m.
cv::Mat1w kitti_depth(const cv::Mat1f& depth_m) {
  cv::Mat1w code(depth_m.size());
  std::transform(depth_m.begin(), depth_m.end(), code.begin(), [](float metres) {
    const float scaled = metres * kKittiDepthScale + 0.5F;
    return scaled < 65536 ? static_cast<std::uint16_t>(scaled) : std::uint16_t{0};
  });
  return code;
}

}  // namespace

/// Optical flow in KITTI's 16-bit PNG and Middlebury's .flo: the full motion, and the camera's part
/// of it.
Writer flow_writer(const SequenceInfo&) {
  return {[](const FrameView& frame, FrameOutput& output) {
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
  }};
}

/// Depth along the optical axis in KITTI's format: 16-bit PNG, 256 codes per metre.
Writer depth_writer(const SequenceInfo&) {
  return {[](const FrameView& frame, FrameOutput& output) {
    output.files.push_back({fmt::format("depth/{:06}.png", frame.now.index),
                            encode_png(kitti_depth(frame.now.truth.depth_m), PngFilter::sub), ""});
  }};
}

}  // namespace lcs::sequence
