#include "tools/recording/recording.h"

namespace lcs::bench {

void set_corner_truth(Truth truth, FrameRecord& frame) {
  sim::CornerTruth of_each;
  of_each.label = truth == Truth::nothing_moves ? sim::Label::fixed : sim::Label::none;
  frame.corner_truth.assign(frame.corners_px.size(), of_each);
}

Recording unspoken(const Recording& recording) {
  Recording unspoken;
  unspoken.scenario = recording.scenario;
  unspoken.seed = recording.seed;
  unspoken.world = recording.world;
  unspoken.camera = recording.camera;
  unspoken.truth = recording.truth;
  unspoken.objects = recording.objects;
  unspoken.warnings = recording.warnings;
  unspoken.frames.reserve(recording.frames.size());
  for (const FrameRecord& given : recording.frames) {
    FrameRecord& frame = unspoken.frames.emplace_back();
    frame.index = given.index;
    frame.t_ns = given.t_ns;
    frame.corners_px = given.corners_px;
    frame.signatures = given.signatures;
    frame.motion = given.motion;
    frame.true_motion = given.true_motion;
    frame.corner_truth = given.corner_truth;
    frame.object_truth = given.object_truth;
    frame.labels = given.labels;
  }
  return unspoken;
}

}  // namespace lcs::bench
