/// \file
/// A world that passes the frames of a camera, one after the other, and the readings between them.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/shutter.h"
#include "sim/imu/imu.h"
#include "sim/world/world.h"

namespace lcs::sim {

/// The world at an instant at which event pixels may see it.
struct EventInstant {
  std::int64_t t_ns = 0;
  ScenePoses stage;
  Snapshot snapshot;
};

/// The world during a frame.
struct FrameState {
  /// \name At the time of the frame.
  ///@{
  Snapshot now;
  Pose T_WB;
  Eigen::Vector3d v_WC_mps = Eigen::Vector3d::Zero();
  Eigen::Vector3d w_C_radps = Eigen::Vector3d::Zero();
  ///@}
  /// \name At `Shutter::instants_ns`; empty for an instant shutter. Before time 0 the rover and
  /// free bodies have the velocities of time 0, and actors stand.
  ///@{
  std::vector<Snapshot> snapshots;
  std::vector<ScenePoses> stages;
  ///@}
  /// After the frame before, up to the time of this one: `kEventCells`; of the first frame the one
  /// of time 0. Empty without event pixels.
  std::vector<EventInstant> event_instants;
};

/// The instants of a shutter and of event pixels are events of the world, so that the steps of the
/// physics end there.
class Passage {
 public:
  /// \param world at t = 0; must outlive the passage. Passes the first frame.
  Passage(World& world, const scenario::Scenario& scenario);

  const Shutter& shutter() const { return shutter_; }
  /// Number and state of the next frame. With an instant shutter the world is at its time, else at
  /// the end of its window.
  int index() const { return index_; }
  const FrameState& frame() const { return frame_; }
  FrameState& frame() { return frame_; }

  /// Passes the frame after the next one, which becomes the next one. \param frame receives number,
  /// time and readings of the frame that was the next one. \throws PhysicsError
  void advance(FrameReadings& frame);

  /// The readings after those of the frame before the next one, up to the first of the IMU at or
  /// after the end of that frame's shutter; none with an instant shutter.
  FrameReadings late_readings() const;

 private:
  void pass_frame();
  void advance_to(std::int64_t t_ns);
  std::int64_t event_instant_ns() const;

  World& world_;
  double rate_hz_;
  std::int64_t told_later_ns_;  ///< the filter is told a later time for a frame than the true one
  Shutter shutter_;
  int index_ = 0;
  FrameState frame_;
  FrameReadings readings_;  ///< those that no frame has got yet
  bool has_events_;
  std::int64_t event_instants_ = 0;           ///< number of those passed
  std::vector<EventInstant> early_instants_;  ///< later than the next frame
};

}  // namespace lcs::sim
