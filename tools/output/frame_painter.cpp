#include "tools/output/result.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/scoring/score_rebels.h"
#include "tools/scoring/score_squares.h"

namespace lcs::output {
namespace {

std::vector<Mark> corner_marks(const recording::FrameRecord& frame) {
  std::vector<Mark> marks;
  for (std::size_t i = 0; i < frame.corner_truth.size(); ++i) {
    const sim::Label label = frame.corner_truth[i].label;
    const bool said_rebel = frame.verdicts[i] == Verdict::rebel;
    marks.push_back(label == sim::Label::rebel ? (said_rebel ? Mark::found : Mark::missed)
                    : label == sim::Label::fixed && said_rebel ? Mark::wrong
                                                               : Mark::none);
  }
  return marks;
}

std::vector<Mark> circle_marks(const recording::FrameRecord& frame) {
  const std::vector<const Circle*> wrong = scoring::false_circles(frame);
  std::vector<Mark> marks;
  for (const Circle& circle : frame.layers.rebel_circles) {
    marks.push_back(std::ranges::find(wrong, &circle) != wrong.end() ? Mark::wrong : Mark::found);
  }
  return marks;
}

std::vector<Mark> square_marks(const recording::FrameRecord& frame,
                               const scoring::SquareOutcomes& outcomes) {
  std::vector<Mark> marks;
  for (const Square& square : frame.layers.squares) {
    const bool right = std::ranges::find(outcomes.right, square.id, &scoring::BoxPair::square) !=
                       outcomes.right.end();
    const bool wrong = std::ranges::find(outcomes.wrong, square.id) != outcomes.wrong.end();
    marks.push_back(right ? Mark::found : wrong ? Mark::wrong : Mark::none);
  }
  return marks;
}

}  // namespace

cv::Mat3b painted(const PanelSheet& sheet, const recording::RunInfo& run,
                  const recording::FrameRecord& frame, const cv::Mat3b& image) {
  const bool is_truth_known = run.truth == recording::Truth::all;
  scoring::SquareOutcomes outcomes;
  if (is_truth_known) outcomes = scoring::square_outcomes(frame);
  // Pixel edges to pixel centres: the outermost centres of pixels l to r-1 are at l and r-1.
  std::vector<TruthBox> truth;
  for (const sim::ObjectTruth& object : frame.object_truth) {
    const auto named = std::ranges::find(run.objects, object.object, &sim::Object::id);
    const bool found = std::ranges::find(outcomes.right, object.object, &scoring::BoxPair::box) !=
                       outcomes.right.end();
    truth.push_back({Vec2(object.left, object.top), Vec2(object.right - 1, object.bottom - 1),
                     object.moving, named == run.objects.end() ? "" : named->name,
                     outcomes.eligible.contains(object.object) && !found});
  }
  if (frame.labels) {
    for (const recording::LabelledBox& label : *frame.labels) {
      truth.push_back(
          {Vec2(label.left, label.top), Vec2(label.right - 1, label.bottom - 1), !label.ignored});
    }
  }
  PanelContent content{.image = image,
                       .corners_px = frame.corners_px,
                       .verdicts = frame.verdicts,
                       .layers = frame.layers,
                       .paper = frame.paper,
                       .truth = truth,
                       .caption = fmt::format("{}  frame {}  {:.2f} s", run.scenario, frame.index,
                                              static_cast<double>(frame.t_ns) * 1e-9)};
  std::vector<Mark> corners, circles, squares;
  std::vector<Vec2> radial_px;
  if (is_truth_known) {
    content.corner_marks = corners = corner_marks(frame);
    for (std::size_t i = 0; i < frame.corner_truth.size(); ++i) {
      if (frame.corner_truth[i].radial) radial_px.push_back(frame.corners_px[i].cast<double>());
    }
    content.radial_px = radial_px;
    content.rebel_circle_marks = circles = circle_marks(frame);
    content.square_marks = squares = square_marks(frame, outcomes);
  }
  return sheet.draw(content);
}

}  // namespace lcs::output
