// Depth along the optical axis in KITTI's format: 16-bit PNG, 256 codes per metre.
#include <fmt/format.h>

#include <algorithm>

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
  std::transform(depth_m.begin(), depth_m.end(), code.begin(), [](float metres) {
    const float scaled = metres * kKittiDepthScale + 0.5F;
    return scaled < 65536 ? static_cast<std::uint16_t>(scaled) : std::uint16_t{0};
  });
  return code;
}

const MakeWriter make_depth_writer = make_writer<DepthWriter>;

}  // namespace lcs::sequence
