/// \file
/// The comparator `klt`, a baseline of common methods with OpenCV and an IMU. Each corner is
/// tracked back to the image of a baseline ago. A static point lies on the epipolar segment there;
/// other corners move by themselves.
///
/// It gets the same camera motion and ground as the filter. It stores only images, and so decides
/// on two frames.
#pragma once

#include "tools/bench/detector.h"
#include "tools/comparators/backward_flow.h"
#include "tools/comparators/epipolar.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

struct KltParameters {
  FlowParameters flow;
  double residual_px = kStatic_px;  ///< largest distance of a static corner from the segment
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
  std::vector<Vec2> guesses_;  // scratch storage of the current frame
  std::vector<CornerMotion> motions_;
};

}  // namespace lcs::comparators
