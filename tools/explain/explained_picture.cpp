#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "tools/explain/explainer.h"
#include "tools/output/panels.h"

namespace lcs::explain {
namespace {

namespace colour = output::colour;

constexpr int kWidth_px = 768, kHeight_px = 576, kPlot_px = 180;
const cv::Scalar kGrey = cv::Scalar::all(120), kWhite = cv::Scalar::all(255);

/// The values of the history as dots over its frames.
void plot(std::span<const Sighting> history, cv::Mat3b strip) {
  constexpr double kMost = 12;  // ends of the strip, at which values are cut off
  const int first = history.front().frame, frames = history.back().frame - first;
  const auto dot = [&](int frame, double value, const cv::Scalar& ink) {
    const double x = 8 + (strip.cols - 16.0) * (frame - first) / std::max(1, frames);
    const double y = (0.5 - 0.45 * std::clamp(value / kMost, -1.0, 1.0)) * strip.rows;
    if (!std::isnan(value)) cv::circle(strip, {cvRound(x), cvRound(y)}, 3, ink, cv::FILLED);
  };
  cv::line(strip, {0, strip.rows / 2}, {strip.cols, strip.rows / 2}, kGrey);
  cv::putText(strip, "-12 to 12: L grey, m white; misses in px, static blue, moving red",
              {8, strip.rows - 8}, cv::FONT_HERSHEY_SIMPLEX, 0.45, kWhite, 1, cv::LINE_AA);
  for (const Sighting& one : history) {
    dot(one.frame, one.why.miss_px(kStaticX), colour::kNormalEdge);
    dot(one.frame, one.why.miss_px(kMovingX), colour::kRebel);
    dot(one.frame, double{one.why.seen[kLogOdds]}, kGrey);
    dot(one.frame, double{one.why.seen[kBelief]}, kWhite);
  }
}

}  // namespace

cv::Mat3b picture_of(const Explained& said, std::size_t corner, const cv::Mat3b& image) {
  constexpr int kZoom = 6;
  const std::span<const Sighting> history = said.history(corner);
  const Sighting& now = history.back();
  const cv::Point middle(kWidth_px / 2, kHeight_px / 2);
  const auto at = [&](const Vec2& x) {
    const Vec2 off = kZoom * (x - now.why.place_px());
    return middle + cv::Point(cvRound(off.x()), cvRound(off.y()));
  };
  cv::Mat3b picture(kHeight_px + kPlot_px, kWidth_px, cv::Vec3b::all(0));
  cv::Mat3b scene = picture.rowRange(0, kHeight_px), part;
  const cv::Point2d centre(now.why.place_px().x(), now.why.place_px().y());
  cv::getRectSubPix(image, scene.size() / kZoom, centre, part);
  cv::resize(part, scene, scene.size(), 0, 0, cv::INTER_CUBIC);
  for (const auto& [neighbour, weight, belief] : now.why.voices) {
    const double sure = std::abs(double{belief});
    const cv::Scalar ink = belief > 0 ? colour::kRebel : colour::kNormalEdge;
    cv::line(scene, middle, at(said.place_px(static_cast<std::size_t>(neighbour))),
             sure * ink + (1 - sure) * kGrey, 1 + cvRound(5 * weight), cv::LINE_AA);
  }
  const auto cross = [&](TrackColumn x, const cv::Scalar& ink) {
    if (std::isnan(now.why.miss_px(x))) return;
    for (const auto& [each, width] : {std::pair(kWhite, 5), std::pair(ink, 2)}) {
      cv::drawMarker(scene, at(now.why.predicted_px(x)), each, cv::MARKER_TILTED_CROSS, 16, width);
    }
  };
  cv::circle(scene, middle, 7, kWhite, 2, cv::LINE_AA);
  cross(kStaticX, colour::kNormalEdge);
  cross(kMovingX, colour::kRebel);
  plot(history, picture.rowRange(kHeight_px, picture.rows));
  return picture;
}

}  // namespace lcs::explain
