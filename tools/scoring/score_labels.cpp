#include "tools/scoring/scores.h"

#include <algorithm>
#include <utility>

#include "tools/recording/box.h"
#include "tools/scoring/scoring.h"

namespace lcs::scoring {
namespace {

constexpr double kMatch = 0.5;

/// A corner at an outline may lie this far outside of its object (FAST's circle), and labels by
/// hand are no more exact.
constexpr double kReach_px = 3;

struct Labelled {
  recording::Box box, reach;
  bool ignored;
};

std::vector<Labelled> labelled(const recording::FrameRecord& frame) {
  std::vector<Labelled> all;
  for (const recording::LabelledBox& label : *frame.labels) {
    const recording::Box box = recording::box_of(label);
    const Vec2 reach = Vec2::Constant(kReach_px);
    all.push_back({box, {box.min() - reach, box.max() + reach}, label.ignored});
  }
  return all;
}

bool in_any(const std::vector<Labelled>& labels, const Vec2& px) {
  return std::ranges::any_of(labels,
                             [&](const Labelled& label) { return label.reach.contains(px); });
}

std::vector<Vec2> rebel_corners(const recording::FrameRecord& frame) {
  std::vector<Vec2> corners;
  for (std::size_t i = 0; i < frame.corners_px.size(); ++i) {
    if (frame.verdicts[i] == Verdict::rebel) corners.push_back(frame.corners_px[i].cast<double>());
  }
  return corners;
}

bool is_off(const Circle& circle, const recording::FrameRecord& frame,
            const std::vector<Labelled>& labels) {
  if (in_any(labels, circle.location)) return false;
  return std::ranges::none_of(frame.corners_px, [&](const Eigen::Vector2f& corner) {
    const Vec2 px = corner.cast<double>();
    return (px - circle.location).norm() <= circle.radius && in_any(labels, px);
  });
}

/// The number of boxes matched one to one by squares. List positions break ties.
int count_boxed(const recording::FrameRecord& frame, const std::vector<Labelled>& labels) {
  std::vector<BoxPair> pairs;
  for (std::size_t i = 0; i < labels.size(); ++i) {
    if (labels[i].ignored) continue;
    for (std::size_t j = 0; j < frame.layers.squares.size(); ++j) {
      const Square& square = frame.layers.squares[j];
      const double iou =
          recording::intersection_over_union(labels[i].box, recording::box_of(square));
      if (may_move(square) && iou >= kMatch) pairs.push_back({iou, static_cast<int>(i), j});
    }
  }
  return static_cast<int>(one_to_one(std::move(pairs)).size());
}

}  // namespace

bool may_move(const Square& square) {
  return square.rebel_circles > 0 || square.circles == 0;
}

void LabelScore::add(const recording::FrameRecord& frame) {
  if (!frame.labels || frame.index < recording::kSightings) return;
  ++frames;
  const std::vector<Labelled> labels = labelled(frame);
  const std::vector<Vec2> rebels = rebel_corners(frame);
  for (const Labelled& label : labels) {
    if (label.ignored) continue;
    ++boxes;
    found += std::ranges::count_if(rebels, [&](const Vec2& px) {
               return label.reach.contains(px);
             }) >= kCornersToFind;
  }
  boxed += count_boxed(frame, labels);
  rebels_off += static_cast<int>(
      std::ranges::count_if(rebels, [&](const Vec2& px) { return !in_any(labels, px); }));
  circles_off +=
      static_cast<int>(std::ranges::count_if(frame.layers.rebel_circles, [&](const Circle& circle) {
        return is_off(circle, frame, labels);
      }));
}

}  // namespace lcs::scoring
