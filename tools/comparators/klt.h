/// \file
/// The comparator `klt`: what OpenCV and an IMU give in an afternoon. Each corner is tracked back
/// to the image of a baseline ago; a static point must have been on the epipolar segment there.
/// What was elsewhere moves by itself.
///
/// It is told the same of the camera's motion and of the ground as the filter, remembers images and
/// nothing else, and so decides on two frames.
#pragma once

#include "tools/bench/detector.h"
#include "tools/comparators/backward_flow.h"
#include "tools/comparators/epipolar.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

struct KltParameters {
  FlowParameters flow;
  double residual_px = kStatic_px;  ///< distance from the segment that a static corner may have
  GroupParameters groups;
};

class KltDetector : public bench::Detector {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit KltDetector(const Intrinsics& camera, const KltParameters& parameters = {});
  const FrameResult& step(const bench::DetectorInput& input) override;
  Diagnostics diagnostics() const override { return flow_.diagnostics(); }

 private:
  Intrinsics camera_;
  KltParameters parameters_;
  BackwardFlow flow_;
  RebelGroups groups_;
  std::vector<Vec2> guesses_;  // of the current frame; kept for their memory
  std::vector<CornerMotion> motions_;
};

}  // namespace lcs::comparators
