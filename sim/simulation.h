/// \file
/// A scenario brought to life: a MuJoCo world with a rover, actors, a camera and an IMU that hands
/// out one `Observation` a frame.
#pragma once

#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/imu.h"
#include "sim/pose.h"
#include "sim/truth.h"
#include "sim/warnings.h"

namespace lcs::sim {

struct Observation {
  int index = 0;               ///< k, from 0
  std::int64_t t_ns = 0;       ///< k / rate, from 0
  cv::Mat3b image;             ///< BGR
  std::vector<ImuSample> imu;  ///< t(k-1) < t <= t(k); the first frame has the sample at 0
  std::vector<OdometrySample> odometry;  ///< likewise; empty when disabled
  std::vector<ImuTruth> imu_truth;       ///< at the same times as `imu`, and in its gaps
  FrameTruth truth;
  std::vector<ObjectTruth> objects;  ///< those with at least one visible pixel, by id
};

/// What the filter's user is told before the first frame: where the sensors are mounted, and the
/// state that dead reckoning starts from. Exact but for `camera.told` of the scenario.
struct Calibration {
  Pinhole camera;
  Pose T_BC;  ///< camera in the rover
  Pose T_BS;  ///< IMU in the rover
  Pose T_WB_start;
  Eigen::Vector3d v_WB_start_mps = Eigen::Vector3d::Zero();
  double gravity_mps2 = 9.81;  ///< along -z of W
  bool on_ground = false;      ///< the rover's origin stays on the ground, which is level
};

/// Thrown when MuJoCo warns or fails (bad qacc and the like): names the simulated time.
class PhysicsError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// \throws scenario::Error for a scenario whose frames are recorded: it has no world to simulate.
const scenario::Scenario& require_scene(const scenario::Scenario& scenario);

/// Owns the world and the GL context; to be used from the thread that made it. Two runs of one
/// scenario give the same bits.
class Simulation {
 public:
  /// Loads and checks everything, so that nothing about the scenario can fail later.
  /// \throws scenario::Error for what is wrong in the scenario (a body that the scene lacks),
  ///   std::runtime_error for what is wrong with the machine (GL that will not start).
  explicit Simulation(const scenario::Scenario& scenario);
  ~Simulation();

  const Calibration& calibration() const;
  const std::vector<Object>& objects() const;
  /// The world that the scene was drawn as; none if it is not stated.
  const std::optional<scenario::Origin>& origin() const;

  /// The warnings until now, or until the last frame.
  const Warnings& warnings() const;

  /// The next frame, or nothing after the scenario's last one.
  /// \throws PhysicsError
  std::optional<Observation> next();

  /// Skips the next frame without rendering it, in a hundredth of the time; the frames after it are
  /// the same as if it had been taken. \throws PhysicsError
  void skip();

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// Versions in use, for `lcs --version` and manifests. Starts GL to ask it.
struct Versions {
  std::string mujoco;       ///< of the library that was loaded
  std::string gl_renderer;  ///< as "llvmpipe (LLVM 15.0.6, 256 bits), Mesa 22.3.6"
};
Versions versions();

}  // namespace lcs::sim
