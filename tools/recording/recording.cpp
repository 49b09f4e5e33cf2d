#include "tools/recording/recording.h"

namespace lcs::bench {

void set_corner_truth(Truth truth, FrameRecord& frame) {
  sim::CornerTruth of_each;
  of_each.label = truth == Truth::nothing_moves ? sim::Label::fixed : sim::Label::none;
  frame.corner_truth.assign(frame.corners_px.size(), of_each);
}

Recording without_detections(const Recording& recording) {
  Recording bare;
  bare.scenario = recording.scenario;
  bare.seed = recording.seed;
  bare.world = recording.world;
  bare.origin = recording.origin;
  bare.camera = recording.camera;
  bare.truth = recording.truth;
  bare.objects = recording.objects;
  bare.warnings = recording.warnings;
  bare.frames.reserve(recording.frames.size());
  for (const FrameRecord& given : recording.frames) {
    FrameRecord& frame = bare.frames.emplace_back();
    frame.index = given.index;
    frame.t_ns = given.t_ns;
    frame.corners_px = given.corners_px;
    frame.signatures = given.signatures;
    frame.gaps = given.gaps;
    frame.motion = given.motion;
    frame.true_motion = given.true_motion;
    frame.corner_truth = given.corner_truth;
    frame.object_truth = given.object_truth;
    frame.labels = given.labels;
  }
  return bare;
}

}  // namespace lcs::bench
