#include "tools/output/panels.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>
#include <vector>

namespace lcs::output {
namespace {

constexpr double kDim = 0.75;       // brightness of the image, so that thin lines stand out
constexpr int kFractionBits = 4;    // OpenCV draws at 1/16 px
constexpr double kDotRadius = 1.6;  // px on the sheet, as the constants below
constexpr double kPredictedHalf = 2;
constexpr double kEdgeHalf = 3;
constexpr int kLayerLine = 2;
constexpr double kMarkReach = 4.5;
constexpr double kDiamondReach = 7;
constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kTextSize = 0.42, kNameSize = 0.4, kTitleSize = 0.5, kLeastTextSize = 0.25;

int even(double length) {
  return std::max(16, 2 * static_cast<int>(std::lround(length / 2)));
}

Vec2 scale_of(cv::Size panel, cv::Size image) {
  return {static_cast<double>(panel.width) / image.width,
          static_cast<double>(panel.height) / image.height};
}

/// Scales about the image's corner, half a pixel from the centre of its first pixel.
Vec2 scaled(const Vec2& image_point, const Vec2& scale) {
  return ((image_point.array() + 0.5) * scale.array() - 0.5).matrix();
}

/// Draws in one panel in image coordinates.
class Pen {
 public:
  Pen(cv::Mat3b panel, cv::Size image)
      : panel_(std::move(panel)), scale_(scale_of(panel_.size(), image)) {}

  void dot(const Vec2& at, const cv::Scalar& colour) {
    cv::circle(panel_, fixed(place(at)), fixed(kDotRadius), colour, cv::FILLED, cv::LINE_AA,
               kFractionBits);
  }
  /// `half` is in px of the sheet, independent of the image's scale.
  void small_square(const Vec2& at, double half, const cv::Scalar& colour) {
    outline(place(at) - Vec2(half, half), place(at) + Vec2(half, half), colour, 1);
  }
  void circle(const Vec2& centre, double radius, const cv::Scalar& colour, int line) {
    cv::circle(panel_, fixed(place(centre)), fixed(radius * scale_.x()), colour, line, cv::LINE_AA,
               kFractionBits);
  }
  void box(const Vec2& min, const Vec2& max, const cv::Scalar& colour, int line) {
    outline(place(min), place(max), colour, line);
  }
  void polygon(std::span<const Vec2> corners, const cv::Scalar& colour) {
    std::vector<cv::Point> points;
    for (const Vec2& corner : corners) points.push_back(fixed(place(corner)));
    cv::polylines(panel_, points, true, colour, 1, cv::LINE_AA, kFractionBits);
  }
  /// Missed: a ring. False: a cross.
  void mark(const Vec2& at, Mark mark) {
    if (mark == Mark::missed) {
      cv::circle(panel_, fixed(place(at)), fixed(kMarkReach), colour::kMissed, 2, cv::LINE_AA,
                 kFractionBits);
    } else if (mark == Mark::wrong) {
      const Vec2 p = place(at);
      for (const double side : {-1.0, 1.0}) {
        cv::line(panel_, fixed(p - kMarkReach * Vec2(1, side)),
                 fixed(p + kMarkReach * Vec2(1, side)), colour::kFalse, 2, cv::LINE_AA,
                 kFractionBits);
      }
    }
  }
  void diamond(const Vec2& at, const cv::Scalar& colour) {
    std::vector<cv::Point> points;
    for (const Vec2& side : {Vec2(1, 0), Vec2(0, 1), Vec2(-1, 0), Vec2(0, -1)}) {
      points.push_back(fixed(place(at) + kDiamondReach * side));
    }
    cv::polylines(panel_, points, true, colour, 1, cv::LINE_AA, kFractionBits);
  }
  /// Below and to the right of an image place.
  void id_of(const Vec2& at, const std::string& text, const cv::Scalar& colour) {
    name(at + (Vec2(4, 15).array() / scale_.array()).matrix(), text, colour);
  }
  /// Above an image place, within the panel; moved by up to two lines to avoid other names.
  void name(const Vec2& at, const std::string& text, const cv::Scalar& colour) {
    int below = 0;
    const cv::Size size = cv::getTextSize(text, kFont, kNameSize, 1, &below);
    const Vec2 p = place(at);
    const auto within = [](double x, int most) {
      return static_cast<int>(std::lround(std::clamp(x, 0.0, std::max(0.0, most * 1.0))));
    };
    const cv::Point corner(within(p.x(), panel_.cols - size.width - 2),
                           within(p.y() - 3, panel_.rows - 3));
    cv::Point seen(corner.x, std::max(corner.y, size.height + 1));
    const int line = size.height + below;
    for (const int lines : {0, -1, 1, -2, 2}) {
      const cv::Rect box(seen.x, seen.y + lines * line - size.height, size.width, line);
      const auto meets = [&](const cv::Rect& other) { return (other & box).area() > 0; };
      if (box.y < 0 || box.y + box.height > panel_.rows) continue;
      if (std::ranges::any_of(names_, meets)) continue;
      seen.y += lines * line;
      break;
    }
    names_.emplace_back(seen.x, seen.y - size.height, size.width, line);
    cv::putText(panel_, text, seen, kFont, kNameSize, cv::Scalar::all(0), 3, cv::LINE_AA);
    cv::putText(panel_, text, seen, kFont, kNameSize, colour, 1, cv::LINE_AA);
  }

 private:
  // Clips far outside of the sheet, as distant layers would overflow OpenCV's fixed point.
  static constexpr double kFarthest = 20000;

  Vec2 place(const Vec2& image_point) const { return scaled(image_point, scale_); }
  static int fixed(double length) {
    return static_cast<int>(
        std::lround(std::clamp(length, -kFarthest, kFarthest) * (1 << kFractionBits)));
  }
  static cv::Point fixed(const Vec2& at) { return {fixed(at.x()), fixed(at.y())}; }
  void outline(const Vec2& min, const Vec2& max, const cv::Scalar& colour, int line) {
    const auto whole = [](double x) {
      return static_cast<int>(std::lround(std::clamp(x, -kFarthest, kFarthest)));
    };
    cv::rectangle(panel_, cv::Point(whole(min.x()), whole(min.y())),
                  cv::Point(whole(max.x()), whole(max.y())), colour, line);
  }

  cv::Mat3b panel_;
  Vec2 scale_;
  std::vector<cv::Rect> names_;  // their boxes
};

/// Drawn over the layers, as a region often coincides with its layer. \return their number.
std::size_t draw_ignored(Pen& pen, const std::vector<IgnoreRegion>& regions,
                         IgnoreRegion::Shape shape) {
  std::size_t drawn = 0;
  for (const IgnoreRegion& region : regions) {
    if (region.shape != shape) continue;
    ++drawn;
    if (shape == IgnoreRegion::Shape::circle) {
      pen.circle(region.location, region.size.x(), colour::kIgnored, kLayerLine);
    } else {
      pen.box(region.location - region.size, region.location + region.size, colour::kIgnored,
              kLayerLine);
    }
  }
  return drawn;
}

/// A word of a legend, after a sample of its colour.
struct Word {
  cv::Scalar colour;
  std::string text;
  enum class Sample : std::uint8_t { fill, line, ring, cross, diamond } sample = Sample::fill;
};
using Sample = Word::Sample;

const Word kMissedWord{colour::kMissed, "missed", Sample::ring};
const Word kFalseWord{colour::kFalse, "false", Sample::cross};

/// Text above and below a panel.
struct PanelText {
  std::string caption;
  std::vector<Word> legend;
};

void write(cv::Mat3b& band, const std::string& text, int x, double size = kTextSize) {
  cv::putText(band, text, {x, (band.rows + 9) / 2}, kFont, size, cv::Scalar::all(255), 1,
              cv::LINE_AA);
}

int width_of(const std::string& text, double size) {
  int below = 0;
  return cv::getTextSize(text, kFont, size, 1, &below).width;
}

void write_legend(cv::Mat3b& band, const std::vector<Word>& words) {
  constexpr int kSample = 10, kGap = 5, kApart = 12;
  double size = kTextSize;
  const auto length = [&] {
    int sum = kGap;
    for (const Word& word : words) sum += kSample + kGap + width_of(word.text, size) + kApart;
    return sum;
  };
  while (length() > band.cols && size > kLeastTextSize) size -= 0.02;
  int x = kGap;
  for (const Word& word : words) {
    const cv::Point middle(x + kSample / 2, band.rows / 2);
    if (word.sample == Sample::ring) {
      cv::circle(band, middle, 4, word.colour, 2, cv::LINE_AA);
    } else if (word.sample == Sample::cross) {
      cv::drawMarker(band, middle, word.colour, cv::MARKER_TILTED_CROSS, 8, 2, cv::LINE_AA);
    } else if (word.sample == Sample::diamond) {
      cv::drawMarker(band, middle, word.colour, cv::MARKER_DIAMOND, 10, 1, cv::LINE_AA);
    } else {
      cv::rectangle(band, middle - cv::Point(4, 4), middle + cv::Point(4, 4), word.colour,
                    word.sample == Sample::fill ? cv::FILLED : 1);
    }
    x += kSample + kGap;
    write(band, word.text, x, size);
    x += width_of(word.text, size) + kApart;
  }
}

/// ": 5 found, 2 false, 1 not counted"; empty if the truth is unknown.
std::string tally(std::span<const Mark> marks) {
  if (marks.empty()) return "";
  std::string text = fmt::format(": {} found, {} false", std::ranges::count(marks, Mark::found),
                                 std::ranges::count(marks, Mark::wrong));
  const auto rest = std::ranges::count(marks, Mark::none);
  return rest > 0 ? text + fmt::format(", {} not counted", rest) : text;
}

/// "; movers' corners: 61 of 64 found; 24 false, 7 of unsure motion"; empty if the truth is
/// unknown. Corners and edges differ in number: an edge may have lost its corner, and a corner seen
/// once has no edge.
std::string tally_of_corners(const PanelContent& content) {
  const std::span<const Mark> marks = content.corner_marks;
  if (marks.empty()) return "";
  const auto rebels = std::ranges::count(content.verdicts, Verdict::rebel);
  const auto found = std::ranges::count(marks, Mark::found);
  const auto wrong = std::ranges::count(marks, Mark::wrong);
  std::string text = fmt::format("; movers' corners: {} of {} found; {} false", found,
                                 found + std::ranges::count(marks, Mark::missed), wrong);
  if (const auto rest = rebels - found - wrong; rest > 0) {
    text += fmt::format(", {} of unsure motion", rest);  // by less than 1 px, or without a label
  }
  return text;
}

/// Only where there is a region psi: the default filter makes none.
void add_psi(std::size_t regions, PanelText& text) {
  if (regions == 0) return;
  text.legend.push_back(
      {colour::kIgnored, fmt::format("psi: {} not looked at", regions), Sample::line});
}

PanelText draw_corners(Pen& pen, const PanelContent& content) {
  for (const Collector& collector : content.paper.collectors) {
    pen.circle(collector.location, collector.radius, colour::kCollector, 1);
  }
  std::size_t ignored = 0;
  for (std::size_t i = 0; i < content.corners_px.size(); ++i) {
    const bool skipped = content.verdicts[i] == Verdict::ignored;
    ignored += skipped;
    pen.dot(content.corners_px[i].cast<double>(), skipped ? colour::kIgnored : colour::kCorner);
  }
  PanelText text{fmt::format("{} corners", content.corners_px.size() - ignored),
                 {{colour::kCorner, "corner"}}};
  if (ignored > 0) {
    text.caption += fmt::format(", {} ignored", ignored);
    text.legend.push_back({colour::kIgnored, "ignored"});
  }
  if (const std::size_t collectors = content.paper.collectors.size(); collectors > 0) {
    text.caption += fmt::format(", {} collectors (lambda)", collectors);
    text.legend.push_back(
        {colour::kCollector, "collector lambda: where a circle looks for corners", Sample::line});
  }
  return text;
}

PanelText draw_edges(Pen& pen, const PanelContent& content) {
  const Layers& layers = content.layers;
  for (const auto* edges : {&layers.normal_edges, &layers.rebel_edges}) {
    for (const Edge& edge : *edges) {
      pen.small_square(edge.predicted, kPredictedHalf, colour::kPredicted);
    }
  }
  for (const auto* edges : {&layers.normal_edges, &layers.rebel_edges}) {
    const auto& colour = edges == &layers.rebel_edges ? colour::kRebel : colour::kNormalEdge;
    for (const Edge& edge : *edges) pen.small_square(edge.location, kEdgeHalf, colour);
  }
  for (const Vec2& at : content.radial_px) pen.diamond(at, colour::kMovingTruth);
  for (std::size_t i = 0; i < content.corner_marks.size(); ++i) {
    pen.mark(content.corners_px[i].cast<double>(), content.corner_marks[i]);
  }
  PanelText text{fmt::format("{} normal edges, {} rebel{}", layers.normal_edges.size(),
                             layers.rebel_edges.size(), tally_of_corners(content)),
                 {{colour::kNormalEdge, "normal", Sample::line},
                  {colour::kRebel, "rebel: moves by itself", Sample::line},
                  {colour::kPredicted, "predicted", Sample::line}}};
  if (!content.corner_marks.empty()) {
    text.legend.insert(text.legend.end(), {kMissedWord, kFalseWord});
  }
  if (const std::size_t radial = content.radial_px.size(); radial > 0) {
    text.legend.push_back(
        {colour::kMovingTruth, fmt::format("{} radial: may look static", radial), Sample::diamond});
  }
  return text;
}

PanelText draw_circles(Pen& pen, const PanelContent& content) {
  const Layers& layers = content.layers;
  for (const Circle& circle : layers.normal_circles) {
    pen.circle(circle.location, circle.radius, colour::kNormalCircle, kLayerLine);
  }
  for (std::size_t i = 0; i < layers.rebel_circles.size(); ++i) {
    const Circle& circle = layers.rebel_circles[i];
    pen.circle(circle.location, circle.radius, colour::kRebel, kLayerLine);
    if (!content.rebel_circle_marks.empty()) {
      pen.mark(circle.location, content.rebel_circle_marks[i]);
    }
  }
  const std::size_t ignored = draw_ignored(pen, content.paper.ignored, IgnoreRegion::Shape::circle);
  PanelText text{fmt::format("{} normal circles, {} rebel{}", layers.normal_circles.size(),
                             layers.rebel_circles.size(), tally(content.rebel_circle_marks)),
                 {{colour::kNormalCircle, "normal: edges of like motion", Sample::line},
                  {colour::kRebel, "rebel", Sample::line}}};
  add_psi(ignored, text);
  if (!content.rebel_circle_marks.empty()) {
    text.legend.push_back({colour::kFalse, "false: nothing moves there", Sample::cross});
  }
  return text;
}

PanelText draw_squares(Pen& pen, const PanelContent& content) {
  const Layers& layers = content.layers;
  for (const TruthBox& box : content.truth) {
    if (box.missed) pen.box(box.min_px, box.max_px, colour::kMissed, kLayerLine);
  }
  for (const Square& square : layers.squares) {
    pen.box(square.location - square.half_size, square.location + square.half_size, colour::kSquare,
            kLayerLine);
  }
  for (const Square& square : layers.squares) {
    if (square.outline.count > 1) pen.polygon(square.outline.vertices(), colour::kSquare);
  }
  const std::size_t ignored =
      draw_ignored(pen, content.paper.ignored, IgnoreRegion::Shape::rectangle);
  for (std::size_t i = 0; i < layers.squares.size(); ++i) {
    const Square& square = layers.squares[i];
    if (!content.square_marks.empty()) pen.mark(square.location, content.square_marks[i]);
    pen.id_of(square.location - square.half_size, fmt::format("#{}", square.id), colour::kSquare);
  }
  std::size_t missed = 0;
  for (const TruthBox& box : content.truth) {
    missed += box.missed;
    if (box.missed && !box.moving) {
      pen.name({box.min_px.x(), box.max_px.y()}, box.name, colour::kMissed);
    }
  }
  PanelText text{
      fmt::format("{} squares{}", layers.squares.size(), tally(content.square_marks)),
      {{colour::kSquare, "square: an object, #id; thin: the outline of its edges", Sample::line}}};
  add_psi(ignored, text);
  if (!content.square_marks.empty()) {
    text.caption += fmt::format(", {} objects missed", missed);
    text.legend.insert(text.legend.end(),
                       {{colour::kMissed, "object missed", Sample::line}, kFalseWord});
  }
  return text;
}

}  // namespace

PanelSheet::PanelSheet(cv::Size image_px, int panel_px) : image_(image_px) {
  if (image_px.width < 16 || image_px.height < 16 || panel_px < 16) {
    throw std::invalid_argument("an image and a panel must measure at least 16 pixels");
  }
  const double scale = static_cast<double>(panel_px) / std::max(image_px.width, image_px.height);
  panel_ = {even(image_px.width * scale), even(image_px.height * scale)};
}

cv::Rect PanelSheet::area(Panel panel) const {
  const bool right = panel == Panel::edges || panel == Panel::squares;
  const bool below = panel == Panel::circles || panel == Panel::squares;
  const int high = kCaption_px + panel_.height + kLegend_px;
  return {right ? panel_.width : 0, kTitle_px + (below ? high : 0) + kCaption_px, panel_.width,
          panel_.height};
}

Vec2 PanelSheet::at(Panel panel, const Vec2& image_point) const {
  const cv::Rect to = area(panel);
  return Vec2(to.x, to.y) + scaled(image_point, scale_of(panel_, image_));
}

cv::Mat3b PanelSheet::draw(const PanelContent& content) const {
  if (content.image.size() != image_) {
    throw std::invalid_argument("the image is not of the size that the sheet was made for");
  }
  if (content.verdicts.size() != content.corners_px.size()) {
    throw std::invalid_argument("a verdict is needed for each corner to draw");
  }
  const auto is_paired = [](std::span<const Mark> marks, std::size_t size) {
    return marks.empty() || marks.size() == size;
  };
  if (!is_paired(content.corner_marks, content.corners_px.size()) ||
      !is_paired(content.rebel_circle_marks, content.layers.rebel_circles.size()) ||
      !is_paired(content.square_marks, content.layers.squares.size())) {
    throw std::invalid_argument("marks are for each corner, rebel circle or square, or for none");
  }
  cv::Mat3b background;
  cv::resize(content.image, background, panel_, 0, 0, cv::INTER_AREA);
  background *= kDim;

  cv::Mat3b sheet(size_px(), cv::Vec3b(0, 0, 0));
  cv::Mat3b title = sheet(cv::Rect(0, 0, sheet.cols, kTitle_px));
  write(title, content.caption, 5, kTitleSize);
  cv::Mat3b truth_legend =
      title(cv::Rect(sheet.cols / 2, 0, sheet.cols - sheet.cols / 2, kTitle_px));
  write_legend(truth_legend, {{colour::kMovingTruth, "truth: moves", Sample::line},
                              {colour::kStaticTruth, "truth: stands", Sample::line}});
  const auto panel = [&](Panel which, auto draw_layers) {
    const cv::Rect at = area(which);
    cv::Mat3b target = sheet(at);
    background.copyTo(target);
    Pen pen(target, image_);
    for (const TruthBox& box : content.truth) {
      pen.box(box.min_px, box.max_px, box.moving ? colour::kMovingTruth : colour::kStaticTruth, 1);
    }
    const PanelText text = draw_layers(pen, content);
    for (const TruthBox& box : content.truth) {  // names of movers, on top of everything
      if (box.moving && !box.name.empty()) pen.name(box.min_px, box.name, colour::kMovingTruth);
    }
    cv::rectangle(sheet, at, cv::Scalar::all(0), 1);
    cv::Mat3b caption = sheet(cv::Rect(at.x, at.y - kCaption_px, at.width, kCaption_px));
    caption = cv::Vec3b(60, 60, 60);
    double size = kTextSize;
    while (5 + width_of(text.caption, size) > caption.cols && size > kLeastTextSize) size -= 0.02;
    write(caption, text.caption, 5, size);
    cv::Mat3b legend = sheet(cv::Rect(at.x, at.y + at.height, at.width, kLegend_px));
    write_legend(legend, text.legend);
  };
  panel(Panel::corners, draw_corners);
  panel(Panel::edges, draw_edges);
  panel(Panel::circles, draw_circles);
  panel(Panel::squares, draw_squares);
  return sheet;
}

}  // namespace lcs::output
