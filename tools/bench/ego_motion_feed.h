/// \file
/// Computes the ego-motion for detectors, from an observation's sensor readings or exact poses.
#pragma once

#include <optional>

#include "filter/ego_motion/estimator.h"
#include "scenarios/scenario.h"
#include "sim/simulation.h"

namespace lcs::bench {

/// Motion between two poses of a camera, `dt_s` > 0 apart, s.
EgoMotion motion_between(const sim::Pose& T_WC_before, const sim::Pose& T_WC_now, double dt_s);

class EgoMotionFeed {
 public:
  /// The estimator gets the noise of the scenario's sensors, like datasheet values.
  EgoMotionFeed(const scenario::Scenario& scenario, const sim::Calibration& calibration);

  struct Motions {
    EgoMotion told;   ///< from the scenario's source of ego-motion
    EgoMotion exact;  ///< from the poses
  };
  /// Call with every observation, in order.
  Motions next(const sim::Observation& observation);

  /// The estimator, used if the source is the IMU.
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
  std::int64_t told_later_ns_;  ///< than the true times of frames
  bool on_ground_;
  double ground_W_m_;  ///< height of the ground in W
};

}  // namespace lcs::bench
