/// \file
/// From an observation's sensor readings, or exact poses, to the motion that a detector is told.
#pragma once

#include <optional>

#include "filter/ego_motion/estimator.h"
#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::bench {

/// Motion between two poses of a camera, `dt_s` > 0 apart.
EgoMotion motion_between(const sim::Pose& T_WC_before, const sim::Pose& T_WC_now, double dt_s);

class EgoMotionFeed {
 public:
  /// The estimator is told the noise that the scenario's sensors have, as a datasheet would.
  EgoMotionFeed(const scenario::Scenario& scenario, const sim::Calibration& calibration);

  struct Motions {
    EgoMotion told;   ///< from the source that the scenario names
    EgoMotion exact;  ///< from the poses
  };
  /// To be called with every observation, in order.
  Motions next(const sim::Observation& observation);

  /// What estimates the motions where the source is the IMU.
  const EgoMotionEstimator& estimator() const { return estimator_; }

 private:
  EgoMotion exact(const sim::Observation& observation);
  EgoMotion estimated(const sim::Observation& observation);

  scenario::EgoMotionSource source_;
  EgoMotionEstimator estimator_;
  struct Frame {
    std::int64_t t_ns;
    sim::Pose T_WC;
  };
  std::optional<Frame> last_;
  bool on_ground_;
  double ground_W_m_;  ///< height of the ground in W
};

}  // namespace lcs::bench
