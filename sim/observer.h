/// \file
/// A world with its camera: gives the same observations as `Simulation`, and access to the world.
#pragma once

#include <cstdint>
#include <opencv2/core.hpp>
#include <vector>

#include "sim/camera_renderer.h"
#include "sim/photograph.h"
#include "sim/silhouette.h"
#include "sim/simulation.h"
#include "sim/world.h"

namespace lcs::sim {

/// Cannot be moved, and is used from the thread that made it: it holds the GL context.
class Observer {
 public:
  /// \throws as `Simulation`.
  Observer(const scenario::Scenario& scenario, WrongStart wrong_start);

  const scenario::Scenario& scenario() const { return scenario_; }
  const Calibration& calibration() const { return calibration_; }
  /// At the time of the frame that comes next.
  const World& world() const { return world_; }
  int next_index() const { return next_index_; }  ///< of the frame that comes next

  /// The next frame, whatever the scenario's number of them. \throws PhysicsError
  Observation observe();
  /// Skips the next frame: moves on to the time of the one after it, and keeps the readings until
  /// then. \throws PhysicsError
  void advance();

 private:
  void render(Observation& o);
  std::vector<ObjectTruth> visible_objects(const FrameTruth& truth) const;

  scenario::Scenario scenario_;
  World world_;
  CameraRenderer renderer_;
  std::vector<ConvexParts> parts_;
  Calibration calibration_;
  Photographer photographer_;
  Snapshot snapshot_;           ///< at the frame that comes next
  std::vector<ImuSample> imu_;  ///< since the last frame
  std::vector<OdometrySample> odometry_;
  std::vector<ImuTruth> imu_truth_;
  int next_index_ = 0;
  cv::Mat1i geoms_;
};

}  // namespace lcs::sim
