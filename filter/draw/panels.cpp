#include "filter/draw/panels.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

namespace lcs {
namespace {

constexpr double kDim = 0.75;       // of the image's brightness, so that thin lines stand out
constexpr int kFractionBits = 4;    // OpenCV draws at 1/16 px
constexpr double kDotRadius = 1.6;  // px on the sheet, as all that follow
constexpr double kPredictedHalf = 2;
constexpr double kEdgeHalf = 3;
constexpr int kLayerLine = 2;

int even(double length) {
  return std::max(16, 2 * static_cast<int>(std::lround(length / 2)));
}

Vec2 scale_of(cv::Size panel, cv::Size image) {
  return {static_cast<double>(panel.width) / image.width,
          static_cast<double>(panel.height) / image.height};
}

/// Scales about the corner of the image, which lies half a pixel off the centre of its first pixel.
Vec2 scaled(const Vec2& image_point, const Vec2& scale) {
  return ((image_point.array() + 0.5) * scale.array() - 0.5).matrix();
}

/// Draws in one panel with the image's own coordinates.
class Pen {
 public:
  Pen(cv::Mat3b panel, cv::Size image)
      : panel_(std::move(panel)), scale_(scale_of(panel_.size(), image)) {}

  void dot(const Vec2& at, const cv::Scalar& colour) {
    cv::circle(panel_, fixed(place(at)), fixed(kDotRadius), colour, cv::FILLED, cv::LINE_AA,
               kFractionBits);
  }
  /// Of a size on the sheet, whatever the scale of the image.
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
  /// Parts the panel from its neighbours, too.
  void caption(const std::string& text) {
    constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
    constexpr double kSize = 0.42;
    constexpr int kBand = 18;
    cv::rectangle(panel_, {0, 0, panel_.cols, panel_.rows}, cv::Scalar::all(0), 1);
    cv::rectangle(panel_, {0, 0, panel_.cols, kBand}, cv::Scalar::all(0), cv::FILLED);
    cv::putText(panel_, text, {5, kBand - 5}, kFont, kSize, cv::Scalar::all(255), 1, cv::LINE_AA);
  }

 private:
  // A layer far outside would overflow OpenCV's fixed point; nothing of it is to be seen from here
  // on.
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
};

void draw_truth(Pen& pen, std::span<const TruthBox> truth) {
  for (const TruthBox& box : truth) {
    pen.box(box.min_px, box.max_px, box.moving ? colour::kMovingTruth : colour::kStaticTruth, 1);
  }
}

/// On top of the layers: a region and the layer that made it often coincide. \return how many.
std::size_t draw_ignored(Pen& pen, const std::vector<IgnoreRegion>& regions,
                         IgnoreRegion::Shape shape) {
  std::size_t drawn = 0;
  for (const IgnoreRegion& region : regions) {
    if (region.shape != shape) continue;
    ++drawn;
    if (shape == IgnoreRegion::Shape::circle) {
      pen.circle(region.location, region.size.x(), colour::kIgnoreRegion, kLayerLine);
    } else {
      pen.box(region.location - region.size, region.location + region.size, colour::kIgnoreRegion,
              kLayerLine);
    }
  }
  return drawn;
}

std::string count(std::size_t number, const char* what) {
  return "  " + std::to_string(number) + " " + what;
}

void draw_corners(Pen& pen, const PanelContent& content) {
  for (const Collector& collector : content.layers.collectors) {
    pen.circle(collector.location, collector.radius, colour::kCollector, 1);
  }
  std::size_t ignored = 0;
  for (std::size_t i = 0; i < content.corners_px.size(); ++i) {
    const bool skipped = content.verdicts[i] == Verdict::ignored;
    ignored += skipped;
    pen.dot(content.corners_px[i].cast<double>(),
            skipped ? colour::kIgnoredCorner : colour::kCorner);
  }
  pen.caption(content.caption + count(content.corners_px.size() - ignored, "corners") +
              count(ignored, "ignored") + count(content.layers.collectors.size(), "lambda"));
}

void draw_edges(Pen& pen, const PanelContent& content) {
  const Layers& layers = content.layers;
  for (const auto* edges : {&layers.normal_edges, &layers.rebel_edges}) {
    for (const Edge& edge : *edges) {
      pen.small_square(edge.predicted, kPredictedHalf, colour::kPredicted);
    }
  }
  for (const Edge& edge : layers.normal_edges) {
    pen.small_square(edge.location, kEdgeHalf, colour::kNormalEdge);
  }
  for (const Edge& edge : layers.rebel_edges) {
    pen.small_square(edge.location, kEdgeHalf, colour::kRebel);
  }
  pen.caption(content.caption + count(layers.normal_edges.size(), "normal edges") +
              count(layers.rebel_edges.size(), "rebel"));
}

void draw_circles(Pen& pen, const PanelContent& content) {
  const Layers& layers = content.layers;
  for (const Circle& circle : layers.normal_circles) {
    pen.circle(circle.location, circle.radius, colour::kNormalCircle, kLayerLine);
  }
  for (const Circle& circle : layers.rebel_circles) {
    pen.circle(circle.location, circle.radius, colour::kRebel, kLayerLine);
  }
  const std::size_t ignored = draw_ignored(pen, layers.ignored, IgnoreRegion::Shape::circle);
  pen.caption(content.caption + count(layers.normal_circles.size(), "normal circles") +
              count(layers.rebel_circles.size(), "rebel") + count(ignored, "psi"));
}

void draw_squares(Pen& pen, const PanelContent& content) {
  const Layers& layers = content.layers;
  for (const Square& square : layers.squares) {
    pen.box(square.location - square.half_size, square.location + square.half_size, colour::kSquare,
            kLayerLine);
  }
  const std::size_t ignored = draw_ignored(pen, layers.ignored, IgnoreRegion::Shape::rectangle);
  pen.caption(content.caption + count(layers.squares.size(), "squares") + count(ignored, "psi"));
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
  return {right ? panel_.width : 0, below ? panel_.height : 0, panel_.width, panel_.height};
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
  cv::Mat3b background;
  cv::resize(content.image, background, panel_, 0, 0, cv::INTER_AREA);
  background *= kDim;

  cv::Mat3b sheet(size_px());
  const auto panel = [&](Panel which, auto draw_layers) {
    cv::Mat3b target = sheet(area(which));
    background.copyTo(target);
    Pen pen(target, image_);
    draw_truth(pen, content.truth);
    draw_layers(pen, content);
  };
  panel(Panel::corners, draw_corners);
  panel(Panel::edges, draw_edges);
  panel(Panel::circles, draw_circles);
  panel(Panel::squares, draw_squares);
  return sheet;
}

}  // namespace lcs
