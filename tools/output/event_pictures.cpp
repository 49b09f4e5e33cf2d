#include "tools/output/event_pictures.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "sim/pictures/picture_file.h"
#include "tools/scoring/score_rebels.h"

namespace lcs::output {
namespace {

constexpr int kShownQuality = 72;
constexpr int kDiamond_px = 12;  ///< of a radial corner
/// Least width of the crop, px of the kept picture, and margins round the object.
constexpr double kLeastWidth_px = 160, kMargin_px = 14, kMarginShare = 0.25;

// BGR; they also differ in lightness, and the marks in shape.
const cv::Scalar kFound{90, 230, 60}, kMissed{0, 150, 255}, kFalse{255, 60, 255},
    kTruth{255, 255, 120}, kShadow{0, 0, 0}, kOutline{255, 255, 255};

/// A view's crop of the kept picture, and the map from image pixels to its pixels.
struct Cut {
  cv::Rect area;
  double scale = 1;  ///< of the kept picture

  cv::Point at(const Vec2& x) const {
    const double zoom_x = static_cast<double>(kEventPictureWidth_px) / area.width;
    const double zoom_y = static_cast<double>(kEventPictureHeight_px) / area.height;
    return {cvRound(((x.x() + 0.5) * scale - area.x) * zoom_x - 0.5),
            cvRound(((x.y() + 0.5) * scale - area.y) * zoom_y - 0.5)};
  }
};

Cut cut_out(const scoring::EventView& view, const cv::Size& kept, double scale) {
  constexpr double kAspect = static_cast<double>(kEventPictureWidth_px) / kEventPictureHeight_px;
  const Vec2 wanted =
      2 * (scale * (1 + kMarginShare) * view.half_size_px + Vec2(kMargin_px, kMargin_px));
  const double width = std::min({std::max({kLeastWidth_px, wanted.x(), wanted.y() * kAspect}),
                                 static_cast<double>(kept.width), kept.height * kAspect});
  const cv::Size size(std::max(1, cvRound(width)),
                      std::max(1, std::min(kept.height, cvRound(width / kAspect))));
  const auto start = [&](double centre, int length, int available) {
    const double first = (centre + 0.5) * scale - 0.5 * length;
    return cvRound(std::clamp(first, 0.0, static_cast<double>(available - length)));
  };
  return {{start(view.centre_px.x(), size.width, kept.width),
           start(view.centre_px.y(), size.height, kept.height), size.width, size.height},
          scale};
}

/// Missed: a ring. Found, also early: a dot. False: a cross.
void mark(cv::Mat3b& picture, cv::Point at, scoring::CornerOutcome outcome) {
  constexpr int kReach = 3;
  const auto cross = [&](const cv::Scalar& colour, int width) {
    cv::drawMarker(picture, at, colour, cv::MARKER_TILTED_CROSS, 2 * kReach, width, cv::LINE_AA);
  };
  if (outcome == scoring::CornerOutcome::missed) {
    cv::circle(picture, at, kReach, kMissed, 1, cv::LINE_AA);
  } else if (outcome == scoring::CornerOutcome::false_rebel) {
    cross(kShadow, 3);
    cross(kFalse, 1);
  } else {
    cv::circle(picture, at, kReach, kShadow, cv::FILLED, cv::LINE_AA);
    cv::circle(picture, at, kReach - 1, kFound, cv::FILLED, cv::LINE_AA);
  }
}

cv::Mat3b paint(const recording::FrameRecord& frame,
                const std::vector<scoring::CornerOutcome>& outcomes, const cv::Mat3b& kept,
                const Cut& cut, const scoring::ScoredEvent& event) {
  cv::Mat3b picture;
  cv::resize(kept(cut.area), picture, {kEventPictureWidth_px, kEventPictureHeight_px}, 0, 0,
             cut.area.width > kEventPictureWidth_px ? cv::INTER_AREA : cv::INTER_CUBIC);
  const bool of_squares = scoring::family_of(event.kind) == scoring::EventFamily::squares;
  for (const sim::ObjectTruth& truth : frame.object_truth) {
    const bool is_meant = of_squares && truth.object == event.object;
    if (!truth.moving && !of_squares) continue;
    cv::rectangle(picture, cut.at(Vec2(truth.left, truth.top) - Vec2(0.5, 0.5)),
                  cut.at(Vec2(truth.right, truth.bottom) - Vec2(0.5, 0.5)),
                  is_meant ? kMissed : kTruth, 1);
  }
  if (of_squares) {
    for (const Square& square : frame.layers.squares) {
      cv::rectangle(picture, cut.at(square.location - square.half_size),
                    cut.at(square.location + square.half_size), kOutline, 2);
      std::vector<cv::Point> outline;
      for (const Vec2& vertex : square.outline.vertices()) outline.push_back(cut.at(vertex));
      if (!outline.empty()) {
        cv::polylines(picture, outline, true, kOutline, 1, cv::LINE_AA);
      }
    }
    return picture;
  }
  for (const Circle* circle : scoring::false_circles(frame)) {
    const cv::Point rim = cut.at(circle->location + Vec2(circle->radius, 0));
    const cv::Point centre = cut.at(circle->location);
    cv::circle(picture, centre, rim.x - centre.x, kFalse, 1, cv::LINE_AA);
  }
  for (const scoring::CornerOutcome last :
       {scoring::CornerOutcome::found_early, scoring::CornerOutcome::found,
        scoring::CornerOutcome::false_rebel, scoring::CornerOutcome::missed}) {
    for (std::size_t i = 0; i < outcomes.size(); ++i) {
      if (outcomes[i] != last) continue;
      const cv::Point at = cut.at(frame.corners_px[i].cast<double>());
      if (frame.corner_truth[i].radial) {
        cv::drawMarker(picture, at, kTruth, cv::MARKER_DIAMOND, kDiamond_px, 1, cv::LINE_AA);
      }
      mark(picture, at, last);
    }
  }
  return picture;
}

}  // namespace

std::set<int> frames_shown(const std::vector<scoring::ScoredEvent>& events) {
  std::set<int> frames;
  for (const scoring::ScoredEvent& event : events) {
    for (const scoring::EventView& view : event.views) frames.insert(view.frame);
  }
  return frames;
}

void paint_views(const recording::FrameRecord& frame,
                 const std::vector<scoring::CornerOutcome>& outcomes, const FramePictures& pictures,
                 std::vector<scoring::ScoredEvent>& events) {
  double scale = 1;
  const cv::Mat3b kept = pictures.at(static_cast<std::size_t>(frame.index), scale);
  for (scoring::ScoredEvent& event : events) {
    for (scoring::EventView& view : event.views) {
      if (view.frame != frame.index) continue;
      const Cut cut = cut_out(view, kept.size(), scale);
      view.half_size_px = Vec2(cut.area.width, cut.area.height) / (2 * scale);
      // Column 0 begins at -0.5.
      view.centre_px = Vec2(cut.area.x, cut.area.y) / scale + view.half_size_px - Vec2(0.5, 0.5);
      view.jpeg_base64 = scoring::base64(
          sim::encode_jpeg(paint(frame, outcomes, kept, cut, event), kShownQuality));
    }
  }
}

}  // namespace lcs::output
