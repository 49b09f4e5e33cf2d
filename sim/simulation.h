/// \file
/// Simulates a scenario: a MuJoCo world with a rover, actors, a camera and an IMU that yields one
/// `Observation` per frame.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/base/optics.h"
#include "sim/base/physics_error.h"
#include "sim/base/pose.h"
#include "sim/camera/exposure_control.h"
#include "sim/events/event.h"
#include "sim/imu/imu.h"
#include "sim/truth/truth.h"
#include "sim/world/warnings.h"

namespace lcs::sim {

struct Observation : FrameReadings {
  cv::Mat3b image;    ///< BGR
  Exposure exposure;  ///< of `image`
  /// Linear light, BGR, before lens blur, lamps, shadows, weather and sensor. A pixel at an outline
  /// mixes its surfaces, by the area that each covers.
  cv::Mat3f rendered;
  cv::Mat1i geom;  ///< the model's geom at each pixel's middle; -1 for the sky
  /// t(k-1) < t <= t(k), in order; empty without event pixels.
  std::vector<Event> events;
  FrameTruth truth;
  std::vector<ObjectTruth> objects;  ///< objects with at least one visible pixel, by id
};

/// The calibration that the filter gets before the first frame: the mounting of the sensors, and
/// the initial state of dead reckoning. Exact except for `camera.told` of the scenario.
struct Calibration {
  Optics optics;   ///< of the pictures
  Pinhole camera;  ///< of the detectors, which get corners and pictures without distortion
  Pose T_BC;       ///< camera in the rover's frame
  Pose T_BS;       ///< IMU in the rover's frame
  Pose T_WB_start;
  Eigen::Vector3d v_WB_start_mps = Eigen::Vector3d::Zero();
  double time_offset_s = 0;    ///< time by the IMU's clock - time by the camera's, as Kalibr
  double gravity_mps2 = 9.81;  ///< along -z of W
  bool on_ground = false;      ///< the rover's origin stays on the ground, which is level
};

/// \throws input::Error for a scenario of recorded frames: it has no world to simulate.
const scenario::Scenario& require_scene(const scenario::Scenario& scenario);

/// Versions of the libraries that results depend on.
struct Versions {
  std::string mujoco;       ///< of the loaded library
  std::string gl_renderer;  ///< for example "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6"
};
/// For `lcs --version` and manifests. Starts GL to query its version.
Versions versions();

/// Owns the world and the GL context; use it only from the thread that constructed it. Two runs of
/// one scenario give bitwise equal results.
class Simulation {
 public:
  /// Loads and checks everything, so that no fault of the scenario can appear later.
  /// \throws input::Error for a fault of the scenario (a body that the scene lacks),
  /// std::runtime_error for a fault of the machine (GL that does not start).
  explicit Simulation(const scenario::Scenario& scenario);
  ~Simulation();

  const Calibration& calibration() const;
  const std::vector<Object>& objects() const;
  /// The map origin that the scenario or its scene states; absent if neither does.
  const std::optional<scenario::Origin>& origin() const;

  /// The versions in use.
  Versions versions() const;

  /// The warnings until now, or until the last frame.
  const Warnings& warnings() const;

  /// The next frame; empty after the scenario's last frame.
  /// \throws PhysicsError
  std::optional<Observation> next();

  /// The readings between the last frame that `next` gave and the end of its readout and exposure,
  /// with one of the IMU beyond it: so that each row has a pose. None with an instant shutter.
  FrameReadings late_readings() const;

  /// Skips the next frame without rendering, in a hundredth of the time; later frames are the same
  /// as without the skip. Event pixels and `image.auto_exposure` remember its picture, so that with
  /// them it is rendered. \throws PhysicsError
  void skip();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lcs::sim
