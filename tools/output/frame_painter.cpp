#include "tools/output/frame_painter.h"

#include <fmt/format.h>

#include <vector>

namespace lcs::bench {

cv::Mat3b FramePainter::paint(const FrameRecord& frame, const cv::Mat3b& image) const {
  // Pixel edges against pixel centres: the box of pixels l to r-1 has its outermost centres there.
  std::vector<TruthBox> truth;
  for (const sim::ObjectTruth& object : frame.object_truth) {
    truth.push_back(
        {Vec2(object.left, object.top), Vec2(object.right - 1, object.bottom - 1), object.moving});
  }
  if (frame.labels) {
    for (const LabelledBox& label : *frame.labels) {
      truth.push_back(
          {Vec2(label.left, label.top), Vec2(label.right - 1, label.bottom - 1), !label.ignored});
    }
  }
  return sheet_.draw({.image = image,
                      .corners_px = frame.corners_px,
                      .verdicts = frame.verdicts,
                      .layers = frame.layers,
                      .truth = truth,
                      .caption = fmt::format("frame {}  {:.2f} s", frame.index,
                                             static_cast<double>(frame.t_ns) * 1e-9)});
}

}  // namespace lcs::bench
