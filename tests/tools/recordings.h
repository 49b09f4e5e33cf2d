/// \file
/// Synthetic recordings whose figures can be computed by hand.
#pragma once

#include <vector>

#include "tools/recording/recording.h"

namespace lcs::test {

/// Pixels [left, right) x [top, bottom).
struct PixelBox {
  int left, top, right, bottom;
};

class FrameMaker {
 public:
  explicit FrameMaker(int index) {
    frame_.index = index;
    frame_.t_ns = index * std::int64_t{100'000'000};
  }

  FrameMaker& corner(Verdict verdict, sim::Label label, int object = 0, bool radial = false,
                     Eigen::Vector2f px = {300, 300}) {
    frame_.corners_px.push_back(px);
    frame_.verdicts.push_back(verdict);
    sim::CornerTruth truth;
    truth.label = label;
    truth.object = object;
    truth.radial = radial;
    truth.depth_m = 2;
    frame_.corner_truth.push_back(truth);
    return *this;
  }
  FrameMaker& corners(int count, Verdict verdict, sim::Label label, int object = 0,
                      bool radial = false) {
    for (int i = 0; i < count; ++i) corner(verdict, label, object, radial);
    return *this;
  }
  FrameMaker& object(int id, PixelBox box, bool moving, double visible_fraction = 1) {
    sim::ObjectTruth truth;
    truth.object = id;
    truth.left = box.left;
    truth.top = box.top;
    truth.right = box.right;
    truth.bottom = box.bottom;
    truth.visible_px = (box.right - box.left) * (box.bottom - box.top);
    truth.visible_fraction = visible_fraction;
    truth.moving = moving;
    frame_.object_truth.push_back(truth);
    return *this;
  }
  /// Makes all pixels of the last object's box visible.
  FrameMaker& full() {
    sim::ObjectTruth& truth = frame_.object_truth.back();
    truth.mask = {0, static_cast<std::uint32_t>(truth.visible_px)};
    return *this;
  }
  /// Adds a square that covers exactly these pixels.
  FrameMaker& square(Id id, PixelBox box) {
    Square square;
    square.id = id;
    const Vec2 min(box.left - 0.5, box.top - 0.5), max(box.right - 0.5, box.bottom - 0.5);
    square.location = (min + max) / 2;
    square.half_size = (max - min) / 2;
    frame_.layers.squares.push_back(square);
    return *this;
  }
  FrameMaker& rebel_circle(Vec2 centre, double radius) {
    Circle circle;
    circle.rebel = true;
    circle.location = centre;
    circle.radius = radius;
    frame_.layers.rebel_circles.push_back(circle);
    return *this;
  }

  operator recording::FrameRecord() const { return frame_; }
  recording::FrameRecord& record() { return frame_; }

 private:
  recording::FrameRecord frame_;
};

inline recording::Recording recording_of(std::vector<recording::FrameRecord> frames) {
  recording::Recording recording;
  recording.scenario = "made_by_hand";
  recording.seed = 7;
  recording.objects = {{1, "mover"}, {2, "picture"}};
  recording.frames = std::move(frames);
  return recording;
}

}  // namespace lcs::test
