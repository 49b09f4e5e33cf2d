#include "tools/recording/recording.h"

#include <utility>

namespace lcs::recording {

void set_corner_truth(Truth truth, FrameRecord& frame) {
  sim::CornerTruth of_each;
  of_each.label = truth == Truth::nothing_moves ? sim::Label::fixed : sim::Label::none;
  frame.corner_truth.assign(frame.corners_px.size(), of_each);
}

FrameRecord without_detections(FrameRecord frame) {
  frame.verdicts.clear();
  frame.reasons.clear();
  frame.log_odds.clear();
  frame.layers = {};
  frame.paper = {};
  frame.masks.clear();
  frame.times.reset();
  return frame;
}

Recording without_detections(Recording recording) {
  recording.detector = {};
  for (FrameRecord& frame : recording.frames) frame = without_detections(std::move(frame));
  return recording;
}

}  // namespace lcs::recording
