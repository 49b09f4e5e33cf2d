#include "tools/output/panels.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace lcs::output {
namespace {

/// Height of title, captions and legends.
constexpr int kBands_px =
    PanelSheet::kTitle_px + 2 * (PanelSheet::kCaption_px + PanelSheet::kLegend_px);

/// A frame with an empty filter, which tests fill.
struct Scene {
  cv::Mat3b image = cv::Mat3b(480, 640, {80, 80, 80});
  std::vector<Eigen::Vector2f> corners;
  std::vector<Verdict> verdicts;
  Layers layers;
  PaperLayers paper;
  std::vector<TruthBox> truth;
  std::vector<Mark> corner_marks = {}, circle_marks = {}, square_marks = {};

  cv::Mat3b draw(const PanelSheet& sheet) const {
    return sheet.draw({.image = image,
                       .corners_px = corners,
                       .verdicts = verdicts,
                       .layers = layers,
                       .paper = paper,
                       .truth = truth,
                       .caption = "frame 1",
                       .corner_marks = corner_marks,
                       .rebel_circle_marks = circle_marks,
                       .square_marks = square_marks});
  }
};

double difference(const cv::Vec3b& pixel, const cv::Scalar& colour) {
  double largest = 0;
  for (int c = 0; c < 3; ++c) largest = std::max(largest, std::abs(pixel[c] - colour[c]));
  return largest;
}

/// Whether a colour is visible at a place of the image, or at an adjacent pixel. Lines are
/// smoothed, so a pixel only needs to be near the colour (a quarter of the range).
bool shows(const cv::Mat3b& drawn, const PanelSheet& sheet, Panel panel, Vec2 at,
           const cv::Scalar& colour) {
  const Vec2 place = sheet.at(panel, at);
  const cv::Point centre(static_cast<int>(std::lround(place.x())),
                         static_cast<int>(std::lround(place.y())));
  for (int dy = -1; dy <= 1; ++dy) {
    for (int dx = -1; dx <= 1; ++dx) {
      const cv::Point pixel = centre + cv::Point(dx, dy);
      if (!cv::Rect({}, drawn.size()).contains(pixel)) continue;
      if (difference(drawn(pixel), colour) < 64) return true;
    }
  }
  return false;
}

/// Whether the place and the pixels around it show only the background.
bool is_bare(const cv::Mat3b& drawn, const PanelSheet& sheet, Panel panel, Vec2 at) {
  const Vec2 place = sheet.at(panel, at);
  const cv::Mat3b around =
      drawn(cv::Rect(static_cast<int>(place.x()) - 1, static_cast<int>(place.y()) - 1, 3, 3));
  return std::all_of(around.begin(), around.end(), [](const cv::Vec3b& pixel) {
    // The image is dimmed, never brightened or coloured.
    return pixel[0] == pixel[1] && pixel[1] == pixel[2] && pixel[0] <= 80 && pixel[0] >= 40;
  });
}

constexpr Panel kAllPanels[] = {Panel::corners, Panel::edges, Panel::circles, Panel::squares};

Edge edge_at(Vec2 location, Vec2 predicted) {
  Edge edge;
  edge.location = location;
  edge.predicted = predicted;
  return edge;
}

Circle circle_at(Vec2 location, double radius) {
  Circle circle;
  circle.location = location;
  circle.radius = radius;
  return circle;
}

TEST(PanelSheet, IsTwoByTwoPanelsOfEvenSizeWhateverTheCamera) {
  EXPECT_EQ(PanelSheet({640, 480}).size_px(), cv::Size(1280, 1072));
  EXPECT_EQ(PanelSheet({1280, 960}).size_px(), cv::Size(1280, 1072));
  EXPECT_EQ(PanelSheet({320, 240}).size_px(), cv::Size(1280, 1072));
  for (const cv::Size camera : {cv::Size(641, 479), cv::Size(333, 777), cv::Size(2000, 20)}) {
    const cv::Size sheet = PanelSheet(camera).size_px();
    EXPECT_EQ(sheet.width % 4, 0);  // each panel even, and two of them
    EXPECT_EQ(sheet.height % 4, 0);
    EXPECT_LE(std::max(sheet.width, sheet.height - kBands_px), 1280);
  }
}

TEST(PanelSheet, RefusesSizesThatCannotBeDrawn) {
  EXPECT_THROW(PanelSheet({0, 480}), std::invalid_argument);
  EXPECT_THROW(PanelSheet({640, 8}), std::invalid_argument);
  EXPECT_THROW(PanelSheet({640, 480}, 4), std::invalid_argument);
}

TEST(PanelSheet, RefusesAnotherImageAndCornersWithoutVerdicts) {
  const PanelSheet sheet({640, 480});
  Scene other;
  other.image = cv::Mat3b(240, 320);
  EXPECT_THROW(other.draw(sheet), std::invalid_argument);
  Scene unpaired;
  unpaired.corners = {{10, 10}};
  EXPECT_THROW(unpaired.draw(sheet), std::invalid_argument);
  Scene marked;
  marked.square_marks = {Mark::wrong};
  EXPECT_THROW(marked.draw(sheet), std::invalid_argument);
}

TEST(PanelSheet, PutsAPixelOfTheImageAtTheSamePlaceOfEveryPanel) {
  const PanelSheet sheet({1280, 960});
  // Half the size: the image's corner, half a pixel off its first pixel's centre, keeps its place.
  constexpr int kTop = PanelSheet::kTitle_px + PanelSheet::kCaption_px;
  constexpr int kBelow = kTop + 480 + PanelSheet::kLegend_px + PanelSheet::kCaption_px;
  EXPECT_TRUE(sheet.at(Panel::corners, {-0.5, -0.5}).isApprox(Vec2(-0.5, kTop - 0.5)));
  EXPECT_TRUE(sheet.at(Panel::edges, {-0.5, -0.5}).isApprox(Vec2(639.5, kTop - 0.5)));
  EXPECT_TRUE(sheet.at(Panel::circles, {99.5, 199.5}).isApprox(Vec2(49.5, kBelow + 99.5)));
  EXPECT_TRUE(sheet.at(Panel::squares, {1279.5, 959.5}).isApprox(Vec2(1279.5, kBelow + 479.5)));
}

class Panels : public testing::TestWithParam<cv::Size> {
 protected:
  Panels() : sheet_(GetParam()) { scene_.image = cv::Mat3b(GetParam(), {80, 80, 80}); }
  PanelSheet sheet_;
  Scene scene_;
};
// At the sheet's own scale, reduced, and enlarged.
INSTANTIATE_TEST_SUITE_P(Cameras, Panels,
                         testing::Values(cv::Size(640, 480), cv::Size(1280, 960),
                                         cv::Size(400, 300)));

TEST(PanelColours, OfTwoMeaningsDiffer) {
  const std::vector<cv::Scalar> all = {
      colour::kCorner,      colour::kIgnored,     colour::kCollector,    colour::kPredicted,
      colour::kNormalEdge,  colour::kRebel,       colour::kNormalCircle, colour::kSquare,
      colour::kMovingTruth, colour::kStaticTruth, colour::kMissed,       colour::kFalse};
  for (std::size_t i = 0; i < all.size(); ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      EXPECT_GE(cv::norm(all[i], all[j], cv::NORM_INF), 64)
          << i << " " << j;  // what `shows` takes as the same
    }
  }
}

TEST_P(Panels, ShowTheDimmedImageWhereThereIsNothing) {
  const cv::Mat3b drawn = scene_.draw(sheet_);
  for (const Panel panel : kAllPanels) EXPECT_TRUE(is_bare(drawn, sheet_, panel, {200, 150}));
}

TEST_P(Panels, CornersAreYellowAndIgnoredOnesOliveInTheFirstPanelOnly) {
  scene_.corners = {{100, 100}, {200, 150}, {250, 250}};
  scene_.verdicts = {Verdict::normal, Verdict::ignored, Verdict::rebel};
  const cv::Mat3b drawn = scene_.draw(sheet_);
  EXPECT_TRUE(shows(drawn, sheet_, Panel::corners, {100, 100}, colour::kCorner));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::corners, {200, 150}, colour::kIgnored));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::corners, {250, 250}, colour::kCorner));
  for (const Panel panel : {Panel::edges, Panel::circles, Panel::squares}) {
    EXPECT_TRUE(is_bare(drawn, sheet_, panel, {100, 100}));
  }
}

TEST_P(Panels, LegendsNameOnlyWhatThereIs) {
  scene_.corners = {{100, 100}};
  scene_.verdicts = {Verdict::normal};
  /// Whether the legend of a panel has a sample of the colour.
  const auto names = [&](Panel panel, const cv::Scalar& colour) {
    const cv::Mat3b drawn = scene_.draw(sheet_);
    const Vec2 corner = sheet_.at(panel, Vec2(-0.5, GetParam().height - 0.5));
    const cv::Mat3b legend =
        drawn(cv::Rect(static_cast<int>(corner.x()) + 1, static_cast<int>(corner.y()) + 2,
                       sheet_.size_px().width / 2 - 4, PanelSheet::kLegend_px - 4));
    return std::any_of(legend.begin(), legend.end(),
                       [&](const cv::Vec3b& pixel) { return difference(pixel, colour) < 8; });
  };
  EXPECT_TRUE(names(Panel::corners, colour::kCorner));
  EXPECT_FALSE(names(Panel::corners, colour::kIgnored));
  EXPECT_FALSE(names(Panel::circles, colour::kIgnored));
  EXPECT_FALSE(names(Panel::squares, colour::kIgnored));
  scene_.verdicts = {Verdict::ignored};
  scene_.paper.ignored = {
      {.shape = IgnoreRegion::Shape::circle, .location = {300, 100}, .size = {40, 0}},
      {.shape = IgnoreRegion::Shape::rectangle, .location = {250, 150}, .size = {30, 60}}};
  EXPECT_TRUE(names(Panel::corners, colour::kIgnored));
  EXPECT_TRUE(names(Panel::circles, colour::kIgnored));
  EXPECT_TRUE(names(Panel::squares, colour::kIgnored));
}

TEST_P(Panels, CollectorsArePinkCirclesAtTheirRadius) {
  scene_.paper.collectors = {{.location = {200, 150}, .radius = 50}};
  const cv::Mat3b drawn = scene_.draw(sheet_);
  for (const Vec2& on : {Vec2(250, 150), Vec2(150, 150), Vec2(200, 100), Vec2(200, 200)}) {
    EXPECT_TRUE(shows(drawn, sheet_, Panel::corners, on, colour::kCollector));
  }
  EXPECT_TRUE(is_bare(drawn, sheet_, Panel::corners, {200, 150}));
  EXPECT_TRUE(is_bare(drawn, sheet_, Panel::corners, {240, 150}));
  EXPECT_TRUE(is_bare(drawn, sheet_, Panel::circles, {250, 150}));
}

TEST_P(Panels, EdgesAreBlueOrRedWithTheirPredictionPale) {
  scene_.layers.normal_edges = {edge_at({100, 100}, {130, 100})};
  scene_.layers.rebel_edges = {edge_at({100, 200}, {130, 200})};
  const cv::Mat3b drawn = scene_.draw(sheet_);
  // Squares of 7 px on the sheet: probe the middle of their right side.
  const double half = 3.0 * GetParam().width / 640;
  EXPECT_TRUE(shows(drawn, sheet_, Panel::edges, {100 + half, 100}, colour::kNormalEdge));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::edges, {100 + half, 200}, colour::kRebel));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::edges, {130 + half, 100}, colour::kPredicted));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::edges, {130 + half, 200}, colour::kPredicted));
  EXPECT_FALSE(shows(drawn, sheet_, Panel::edges, {100 + half, 100}, colour::kRebel));
  for (const Panel panel : {Panel::corners, Panel::circles, Panel::squares}) {
    EXPECT_TRUE(is_bare(drawn, sheet_, panel, {100 + half, 100}));
  }
}

TEST_P(Panels, CirclesAreGreenOrRedAndCircularIgnoranceOlive) {
  scene_.layers.normal_circles = {circle_at({100, 100}, 40)};
  scene_.layers.rebel_circles = {circle_at({200, 100}, 40)};
  scene_.paper.ignored = {
      {.shape = IgnoreRegion::Shape::circle, .location = {300, 100}, .size = {40, 0}}};
  const cv::Mat3b drawn = scene_.draw(sheet_);
  EXPECT_TRUE(shows(drawn, sheet_, Panel::circles, {100, 140}, colour::kNormalCircle));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::circles, {200, 140}, colour::kRebel));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::circles, {300, 140}, colour::kIgnored));
  for (const double x : {100.0, 200.0, 300.0}) {
    EXPECT_TRUE(is_bare(drawn, sheet_, Panel::circles, {x, 100}));
    EXPECT_TRUE(is_bare(drawn, sheet_, Panel::squares, {x, 140}));
  }
}

TEST_P(Panels, SquaresAreWhiteAndRectangularIgnoranceOlive) {
  Square square;
  square.location = {100, 150};
  square.half_size = {30, 60};
  scene_.layers.squares = {square};
  scene_.paper.ignored = {
      {.shape = IgnoreRegion::Shape::rectangle, .location = {250, 150}, .size = {30, 60}}};
  const cv::Mat3b drawn = scene_.draw(sheet_);
  for (const Vec2& on : {Vec2(-30, 0), Vec2(30, 0), Vec2(0, -60), Vec2(0, 60)}) {
    EXPECT_TRUE(shows(drawn, sheet_, Panel::squares, Vec2(100, 150) + on, colour::kSquare));
    EXPECT_TRUE(shows(drawn, sheet_, Panel::squares, Vec2(250, 150) + on, colour::kIgnored));
  }
  EXPECT_TRUE(is_bare(drawn, sheet_, Panel::squares, {100, 150}));
  EXPECT_TRUE(is_bare(drawn, sheet_, Panel::squares, {250, 150}));
  EXPECT_TRUE(is_bare(drawn, sheet_, Panel::circles, {280, 150}));
}

TEST_P(Panels, OutlinesOfSquaresAreThinAndWhite) {
  Square square;
  square.location = {120, 120};
  square.half_size = {60, 60};
  square.outline.count = 4;
  square.outline.places[0] = {60, 120};
  square.outline.places[1] = {120, 60};
  square.outline.places[2] = {180, 120};
  square.outline.places[3] = {120, 180};
  scene_.layers.squares = {square};
  const cv::Mat3b drawn = scene_.draw(sheet_);
  const cv::Mat3b without = [&] {
    scene_.layers.squares[0].outline = {};
    return scene_.draw(sheet_);
  }();
  const auto at = [&](const cv::Mat3b& sheet, const Vec2& place) {
    const Vec2 on = sheet_.at(Panel::squares, place);
    return sheet(cv::Point(cvRound(on.x()), cvRound(on.y())));
  };
  for (const Vec2& on : {Vec2(90, 90), Vec2(150, 90), Vec2(150, 150), Vec2(90, 150)}) {
    EXPECT_GT(at(drawn, on)[1], at(without, on)[1] + 60) << "lighter than the picture";
  }
  for (const Vec2& off : {Vec2(80, 80), Vec2(100, 100), Vec2(140, 140)}) {
    EXPECT_EQ(at(drawn, off), at(without, off));
  }
}

TEST_P(Panels, TruthIsInEveryPanelCyanWhereItMovesAndBeneathTheLayers) {
  scene_.truth = {{{80, 80}, {120, 160}, true}, {{200, 80}, {240, 160}, false}};
  Square square;
  square.location = {100, 120};
  square.half_size = {20, 40};
  scene_.layers.squares = {square};
  const cv::Mat3b drawn = scene_.draw(sheet_);
  for (const Panel panel : {Panel::corners, Panel::edges, Panel::circles}) {
    EXPECT_TRUE(shows(drawn, sheet_, panel, {120, 120}, colour::kMovingTruth));
    EXPECT_TRUE(shows(drawn, sheet_, panel, {240, 120}, colour::kStaticTruth));
  }
  EXPECT_TRUE(shows(drawn, sheet_, Panel::squares, {120, 120}, colour::kSquare));
  EXPECT_FALSE(shows(drawn, sheet_, Panel::squares, {120, 120}, colour::kMovingTruth));
}

TEST_P(Panels, LayersFarOutsideTheImageLeaveNoTrace) {
  const cv::Mat3b bare = scene_.draw(sheet_);
  constexpr double kFar = 1e12;
  Square square;
  square.location = {-kFar, 100};
  square.half_size = {10, 10};
  scene_.layers.squares = {square};
  scene_.paper.collectors = {{.location = {kFar, kFar}, .radius = 10}};
  const cv::Mat3b drawn = scene_.draw(sheet_);
  // Only in the images, because the captions contain counts.
  for (const Panel panel : kAllPanels) {
    const Vec2 corner = sheet_.at(panel, {-0.5, -0.5});
    const cv::Rect image(static_cast<int>(corner.x() + 1), static_cast<int>(corner.y() + 1),
                         bare.cols / 2 - 1, (bare.rows - kBands_px) / 2 - 1);
    if (panel == Panel::squares) continue;  // the id of an item out of view is drawn at the edge
    EXPECT_EQ(cv::norm(bare(image), drawn(image), cv::NORM_INF), 0);
  }
}

TEST_P(Panels, MissedAndFalseFindingsAreMarked) {
  scene_.corners = {{100, 100}, {200, 100}, {300, 100}};
  scene_.verdicts = {Verdict::rebel, Verdict::normal, Verdict::rebel};
  scene_.corner_marks = {Mark::found, Mark::missed, Mark::wrong};
  scene_.layers.rebel_circles = {circle_at({100, 100}, 40), circle_at({300, 100}, 40)};
  scene_.circle_marks = {Mark::found, Mark::wrong};
  Square square;
  square.location = {300, 150};
  square.half_size = {30, 60};
  scene_.layers.squares = {square};
  scene_.square_marks = {Mark::wrong};
  scene_.truth = {{{80, 120}, {120, 220}, false, "crate", true}};
  const cv::Mat3b drawn = scene_.draw(sheet_);
  const double ring = 4.5 * GetParam().width / 640;
  EXPECT_TRUE(shows(drawn, sheet_, Panel::edges, {200 + ring, 100}, colour::kMissed));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::edges, {300, 100}, colour::kFalse));
  EXPECT_TRUE(is_bare(drawn, sheet_, Panel::edges, {100, 100}));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::circles, {300, 100}, colour::kFalse));
  EXPECT_TRUE(is_bare(drawn, sheet_, Panel::circles, {100, 100}));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::squares, {300, 150}, colour::kFalse));
  EXPECT_TRUE(shows(drawn, sheet_, Panel::squares, {120, 150}, colour::kMissed));
  EXPECT_FALSE(shows(drawn, sheet_, Panel::circles, {120, 150}, colour::kMissed));
}

TEST_P(Panels, MoversHaveTheirNamesInEveryPanel) {
  scene_.truth = {{{80, 80}, {120, 160}, true}};
  const cv::Mat3b nameless = scene_.draw(sheet_);
  scene_.truth.front().name = "walker";
  const cv::Mat3b drawn = scene_.draw(sheet_);
  for (const Panel panel : kAllPanels) {
    const Vec2 box = sheet_.at(panel, {80, 80});
    const cv::Rect above(static_cast<int>(box.x()), static_cast<int>(box.y()) - 14, 45, 12);
    EXPECT_GT(cv::norm(nameless(above), drawn(above), cv::NORM_INF), 64);
  }
}

TEST_P(Panels, NamesDoNotLieOnEachOther) {
  scene_.truth = {{{80, 80}, {120, 160}, true, "walker"}};
  const cv::Mat3b alone = scene_.draw(sheet_);
  scene_.truth.push_back(scene_.truth.front());
  const cv::Mat3b both = scene_.draw(sheet_);
  for (const Panel panel : kAllPanels) {
    const Vec2 box = sheet_.at(panel, {80, 80});
    cv::Rect name(static_cast<int>(box.x()), static_cast<int>(box.y()) - 10, 45, 8);
    EXPECT_EQ(cv::norm(alone(name), both(name), cv::NORM_INF), 0);
    name.y -= 12;
    EXPECT_GT(cv::norm(alone(name), both(name), cv::NORM_INF), 64) << "a line higher";
  }
}

TEST_P(Panels, NoPanelPaintsOverAnother) {
  scene_.paper.collectors = {{.location = {0, 0}, .radius = 90}};
  const double right = GetParam().width - 1;
  scene_.paper.collectors.push_back({.location = {right, 200}, .radius = 90});
  const cv::Mat3b drawn = scene_.draw(sheet_);
  EXPECT_TRUE(shows(drawn, sheet_, Panel::corners, {right - 90, 200}, colour::kCollector));
  EXPECT_TRUE(is_bare(drawn, sheet_, Panel::edges, {89, 200}));
}

}  // namespace
}  // namespace lcs::output
