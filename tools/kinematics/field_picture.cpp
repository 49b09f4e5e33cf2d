#include "tools/kinematics/field_picture.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/scoring/statistics.h"

namespace lcs::kinematics {
namespace {

const cv::Scalar kTrue{80, 230, 80}, kTrueMoving{60, 60, 255}, kPredicted{0, 230, 255},
    kFoe{255, 255, 255}, kText{240, 240, 240};
constexpr int kPanel_px = 960;    // width of one
constexpr double kArrow_px = 40;  // length of a long one, on the picture
constexpr double kMostGain = 20;
constexpr int kShift = 4;  // sub-pixel bits of OpenCV's drawing
constexpr int kCaption_px = 30;

class Panel {
 public:
  Panel(const cv::Mat3b& image, double gain)
      : scale_(static_cast<double>(kPanel_px) / image.cols), gain_(gain) {
    cv::resize(image, panel_, {}, scale_, scale_, cv::INTER_LINEAR);
    panel_ *= 0.5;
  }

  void arrow(const Vec2& from, const Vec2& to, const cv::Scalar& colour, int thickness) {
    const Vec2 tip = from + gain_ * (to - from);
    cv::line(panel_, at(from), at(tip), colour, thickness, cv::LINE_AA, kShift);
    if (thickness > 1) return;
    cv::circle(panel_, at(tip), 2 << kShift, colour, cv::FILLED, cv::LINE_AA, kShift);
  }
  void cross(const Vec2& px) {
    cv::drawMarker(panel_, cv::Point(cvRound(at(px).x / 16.0), cvRound(at(px).y / 16.0)), kFoe,
                   cv::MARKER_TILTED_CROSS, 18, 2, cv::LINE_AA);
  }
  cv::Mat3b with_caption(const std::string& text) const {
    cv::Mat3b whole(panel_.rows + kCaption_px, panel_.cols, cv::Vec3b(30, 30, 30));
    panel_.copyTo(whole(cv::Rect(0, kCaption_px, panel_.cols, panel_.rows)));
    cv::putText(whole, text, {8, 20}, cv::FONT_HERSHEY_SIMPLEX, 0.48, kText, 1, cv::LINE_AA);
    return whole;
  }

 private:
  cv::Point at(const Vec2& px) const {
    const Vec2 scaled = ((px.array() + 0.5) * scale_ - 0.5) * (1 << kShift);
    return {cvRound(scaled.x()), cvRound(scaled.y())};
  }

  cv::Mat3b panel_;
  double scale_, gain_;
};

/// That makes a long arrow `kArrow_px` long.
double gain_for(const std::vector<Arrow>& arrows, double scale) {
  std::vector<double> lengths;
  for (const Arrow& arrow : arrows) lengths.push_back((arrow.true_px - arrow.from_px).norm());
  const double longest = bench::quantile(lengths, 0.9).value_or(1) * scale;
  return std::clamp(std::floor(kArrow_px / std::max(longest, 1e-9)), 1.0, kMostGain);
}

}  // namespace

cv::Mat3b draw_field(const FieldFrame& frame) {
  const double scale = static_cast<double>(kPanel_px) / frame.image.cols;
  const auto draw = [&](const std::vector<Arrow>& arrows, const cv::Scalar& colour,
                        const std::string& what) {
    const double gain = gain_for(arrows, scale);
    Panel panel(frame.image, gain);
    for (const Arrow& arrow : arrows) panel.arrow(arrow.from_px, arrow.true_px, colour, 3);
    for (const Arrow& arrow : arrows) panel.arrow(arrow.from_px, arrow.predicted_px, kPredicted, 1);
    if (frame.foe_px) panel.cross(*frame.foe_px);
    return panel.with_caption(fmt::format("frame {}: {}  {} corners, motion x{:g}", frame.index,
                                          what, arrows.size(), gain));
  };
  const cv::Mat3b fixed =
      draw(frame.fixed, kTrue, "fixed: true (green), predicted by own V (yellow).");
  if (frame.moving.empty()) return fixed;
  cv::Mat3b both;
  cv::hconcat(fixed,
              draw(frame.moving, kTrueMoving, "movers: true (red), predicted as fixed (yellow)."),
              both);
  return both;
}

}  // namespace lcs::kinematics
