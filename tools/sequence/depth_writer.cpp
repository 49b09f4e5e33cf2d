// Depth along the optical axis in KITTI's format: 16-bit PNG, 256 codes per metre.
#include <fmt/format.h>

#include "tools/sequence/flow_code.h"
#include "tools/sequence/png.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

class DepthWriter : public Writer {
 public:
  using Writer::Writer;

  void write(const FrameView& frame, FrameOutput& output) const override {
    output.files.push_back({fmt::format("depth/{:06}.png", frame.now.index),
                            encode_png(kitti_depth(frame.now.truth.depth_m), PngFilter::sub), ""});
  }
};

}  // namespace

cv::Mat1w kitti_depth(const cv::Mat1f& depth_m) {
  cv::Mat1w code(depth_m.size());
  for (int y = 0; y < code.rows; ++y) {
    const float* from = depth_m[y];
    std::uint16_t* to = code[y];
    for (int x = 0; x < code.cols; ++x) {
      const float scaled = from[x] * kKittiDepthScale + 0.5F;
      to[x] = scaled < 65536 ? static_cast<std::uint16_t>(scaled) : std::uint16_t{0};
    }
  }
  return code;
}

std::unique_ptr<Writer> make_depth_writer(const SequenceInfo& info) {
  return std::make_unique<DepthWriter>(info);
}

}  // namespace lcs::sequence
