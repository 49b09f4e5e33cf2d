/// \file
/// How a recording tells the camera's motion from one frame to the next.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <optional>
#include <vector>

#include "filter/ego_motion/estimator.h"
#include "scenarios/scenario.h"
#include "sim/simulation.h"
#include "tools/bench/ego_motion_feed.h"

namespace lcs::replay {

class MotionSource {
 public:
  virtual ~MotionSource() = default;

  /// Motion since the last frame; of the first one all 0. Times increase.
  virtual EgoMotion at(std::int64_t t_ns) = 0;

  /// Where up is at the last frame, against gravity, seen from the camera; none where nobody knows.
  virtual std::optional<Eigen::Vector3d> up_C() const { return std::nullopt; }

  /// The exact motion to the last frame; none where it is not known.
  virtual std::optional<EgoMotion> exact() const { return std::nullopt; }

  /// What was wrong with the readings that it was told from so far.
  virtual Diagnostics diagnostics() const { return {}; }
};

/// Straight ahead along the optical axis; how it turns nobody tells.
class SteadyMotion : public MotionSource {
 public:
  /// \param mount_rpy_rad of the camera on what stands upright; none: not known.
  SteadyMotion(double speed_mps, const std::optional<Eigen::Vector3d>& mount_rpy_rad);
  EgoMotion at(std::int64_t t_ns) override;
  std::optional<Eigen::Vector3d> up_C() const override { return up_C_; }

 private:
  double speed_mps_;
  std::optional<Eigen::Vector3d> up_C_;
  std::optional<std::int64_t> last_ns_;
};

/// What was recorded of a rover's sensors, by time.
struct SensorReadings {
  std::vector<sim::ImuSample> imu;
  std::vector<sim::OdometrySample> odometry;
  struct CameraPose {
    std::int64_t t_ns;
    sim::Pose T_WC;
  };
  std::vector<CameraPose> poses;  ///< exact, at frames
};

/// Leaves out what was before a time, and counts the rest from there.
void begin_at(std::int64_t t_ns, SensorReadings& readings);

/// Dead reckoning from IMU and odometry, as a run has it (or exact poses where the settings ask for
/// them): the same readings give the same bits.
class SensorMotion : public MotionSource {
 public:
  SensorMotion(const scenario::Scenario& settings, const sim::Calibration& calibration,
               SensorReadings readings);
  /// \throws std::runtime_error where exact poses are asked for and there is none at this time.
  EgoMotion at(std::int64_t t_ns) override;
  std::optional<Eigen::Vector3d> up_C() const override;
  std::optional<EgoMotion> exact() const override { return exact_; }
  Diagnostics diagnostics() const override { return feed_.estimator().diagnostics(); }

 private:
  bool needs_poses_;
  Eigen::Matrix3d R_SC_;
  SensorReadings readings_;
  std::size_t imu_ = 0, odometry_ = 0, pose_ = 0;  ///< the next to be used
  bench::EgoMotionFeed feed_;
  bool had_pose_ = true;  ///< the last frame, or there was none
  std::optional<EgoMotion> exact_;
};

/// Attitude and velocity as a navigation unit tells them, in its own time.
struct NavigationState {
  std::int64_t t_ns = 0;
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Eigen::Vector3d v_WB_mps = Eigen::Vector3d::Zero();
};

/// Differences of attitude, and velocity integrated; linear between two states.
class NavigationMotion : public MotionSource {
 public:
  /// \param states by time, at least two.
  NavigationMotion(std::vector<NavigationState> states, const sim::Pose& T_BC);
  /// Beyond the first and last state those are held.
  EgoMotion at(std::int64_t t_ns) override;
  std::optional<Eigen::Vector3d> up_C() const override;

  std::int64_t first_ns() const { return states_.front().t_ns; }
  std::int64_t last_ns() const { return states_.back().t_ns; }

 private:
  NavigationState state_at(std::int64_t t_ns) const;

  std::vector<NavigationState> states_;
  sim::Pose T_BC_;
  std::optional<NavigationState> last_;
};

/// Differences of a camera's poses; linear between two of them.
class PosesMotion : public MotionSource {
 public:
  using CameraPose = SensorReadings::CameraPose;

  /// \param poses by time, each time once, at least one.
  /// \param up_W against gravity in the world of the poses, if that is known.
  PosesMotion(std::vector<CameraPose> poses, const std::optional<Eigen::Vector3d>& up_W);
  /// Beyond the first and last pose those are held.
  EgoMotion at(std::int64_t t_ns) override;
  std::optional<Eigen::Vector3d> up_C() const override;

  std::int64_t first_ns() const { return poses_.front().t_ns; }
  std::int64_t last_ns() const { return poses_.back().t_ns; }

 private:
  sim::Pose pose_at(std::int64_t t_ns) const;

  std::vector<CameraPose> poses_;
  std::optional<Eigen::Vector3d> up_W_;
  std::optional<CameraPose> last_;
};

}  // namespace lcs::replay
