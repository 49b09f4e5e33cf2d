/// \file
/// The comparator `klt`: what OpenCV and an IMU give in an afternoon. Each corner is tracked back
/// to the last image; a static point must have been on the epipolar segment there, the images of
/// the corner at every depth from the nearest to infinity. What was elsewhere moves by itself.
///
/// It is told the same of the camera's motion as the filter, remembers one image and nothing else,
/// and so decides on two frames.
#pragma once

#include "filter/motion_field.h"
#include "tools/bench/tracker.h"
#include "tools/comparators/backward_flow.h"
#include "tools/comparators/rebel_groups.h"

namespace lcs::comparators {

struct KltParameters {
  FlowParameters flow;
  double nearest_depth_m = 0.8;  ///< z_min, > 0: no static point is nearer; the filter's own
  double residual_px = 1;        ///< distance from the segment that a static corner may have
  GroupParameters groups;
};

/// Distance from where a corner was (rotation removed) to where a static point could have been.
/// \param field of the interval between the frames, with exact rotation.
double epipolar_distance(const MotionField& field, double nearest_depth_m, const Vec2& now_px,
                         const Vec2& before_px);

class KltTracker : public bench::Tracker {
 public:
  /// \throws std::invalid_argument for a parameter out of its range.
  explicit KltTracker(const sim::Pinhole& camera, const KltParameters& parameters = {});
  const FrameResult& step(const bench::TrackerInput& input) override;

 private:
  Intrinsics camera_;
  KltParameters parameters_;
  BackwardFlow flow_;
  RebelGroups groups_;
  std::vector<Vec2> guesses_;  // of the current frame; kept for their memory
  std::vector<CornerMotion> motions_;
};

}  // namespace lcs::comparators
