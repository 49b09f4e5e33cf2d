/// \file
/// Sources of the camera's motion from frame to frame of a recording.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "filter/ego_motion/estimator.h"
#include "filter/ego_motion/intake.h"
#include "scenarios/scenario.h"
#include "sim/base/rotation.h"
#include "sim/simulation.h"
#include "tools/bench/ego_motion_feed.h"

namespace lcs::replay {

using Eigen::Vector3d;

/// Whether a vehicle can have this velocity; larger values come from a corrupt file.
inline bool is_speed(const Vector3d& v_mps) {
  return v_mps.norm() <= kMostSpeed_mps;
}

/// R_BC of a camera mounted by roll, pitch and yaw about the fixed axes of B (x ahead, y left, z
/// up), as `scenario::Camera::mount_rpy_rad`. All 0: it looks along x, upright.
inline Eigen::Matrix3d camera_mount(const Vector3d& rpy_rad) {
  Eigen::Matrix3d ahead;  // C's z is B's x, its x is -y, its y is -z
  ahead << 0, 0, 1, -1, 0, 0, 0, -1, 0;
  return sim::rotation_of_rpy(rpy_rad) * ahead;
}

class MotionSource {
 public:
  /// The same data, read as others write them.
  struct Reading {
    std::string remedy;  ///< what to change where this reading fits, as "they are ...: give ..."
    std::unique_ptr<MotionSource> motion;
  };

  virtual ~MotionSource() = default;

  /// Motion since the previous frame; all 0 for the first one. Times must increase.
  virtual EgoMotion at(std::int64_t t_ns) = 0;

  /// Up (against gravity) at the last frame, in camera coordinates; absent if unknown.
  virtual std::optional<Vector3d> up_C() const { return std::nullopt; }

  /// The exact motion to the last frame; absent if unknown.
  virtual std::optional<EgoMotion> exact() const { return std::nullopt; }

  virtual std::vector<Reading> other_readings() const { return {}; }

  /// Counts of the faults in its readings so far.
  virtual Diagnostics diagnostics() const { return {}; }
};

/// Constant velocity along the optical axis; the rotation is unknown.
class SteadyMotion : public MotionSource {
 public:
  /// \param mount_rpy_rad of the camera on an upright vehicle; absent: unknown.
  SteadyMotion(double speed_mps, const std::optional<Vector3d>& mount_rpy_rad);
  EgoMotion at(std::int64_t t_ns) override;
  std::optional<Vector3d> up_C() const override { return up_C_; }
  /// Of the other sign, or of a camera that does not stand.
  std::vector<Reading> other_readings() const override;

 private:
  double speed_mps_;
  std::optional<Vector3d> up_C_;
  std::optional<std::int64_t> last_ns_;
};

struct CameraPose {
  std::int64_t t_ns;
  sim::Pose T_WC;
};
using CameraPoses = std::vector<CameraPose>;

/// The recorded readings of a rover's sensors, by time.
struct SensorReadings {
  std::vector<sim::ImuSample> imu;
  std::vector<sim::OdometrySample> odometry;
  CameraPoses poses;  ///< exact, at frames
};

/// Removes readings before a time, and counts the remaining times from it.
void begin_at(std::int64_t t_ns, SensorReadings& readings);

/// Dead reckoning from IMU and odometry, or exact poses if the settings ask for them. The same
/// readings give the same bits as in a run.
class SensorMotion : public MotionSource {
 public:
  SensorMotion(const scenario::Scenario& settings, const sim::Calibration& calibration,
               SensorReadings readings);
  /// \throws std::runtime_error if exact poses are requested and none has this time.
  EgoMotion at(std::int64_t t_ns) override;
  std::optional<Vector3d> up_C() const override;
  std::optional<EgoMotion> exact() const override { return exact_; }
  /// With accelerations of the other sign, and the camera's pose on the IMU inverted.
  std::vector<Reading> other_readings() const override;
  Diagnostics diagnostics() const override { return feed_.estimator().diagnostics(); }

 private:
  scenario::Scenario settings_;
  sim::Calibration calibration_;
  bool needs_poses_;
  Eigen::Matrix3d R_SC_;
  SensorReadings readings_;
  std::size_t imu_ = 0, odometry_ = 0, pose_ = 0;  ///< the next to be used
  bench::EgoMotionFeed feed_;
  bool had_pose_ = true;  ///< the last frame had a pose, or there was no frame
  std::optional<EgoMotion> exact_;
};

/// Attitude and velocity from a navigation unit, at its own times.
struct NavigationState {
  std::int64_t t_ns = 0;
  Eigen::Quaterniond q_WB = Eigen::Quaterniond::Identity();
  Vector3d v_WB_mps = Vector3d::Zero();
};

/// Differences of camera poses; linear between two poses.
class PosesMotion : public MotionSource {
 public:
  /// \param poses by time, without duplicate times, at least one.
  /// \param up_W up (against gravity) in the poses' world frame, if known.
  /// \param may_be_misread others write such poses by other conventions.
  PosesMotion(CameraPoses poses, const std::optional<Vector3d>& up_W, bool may_be_misread = true);
  /// Before the first and after the last pose, that pose is held.
  EgoMotion at(std::int64_t t_ns) override;
  std::optional<Vector3d> up_C() const override;
  /// As the world's poses in the camera, and by other orders of a quaternion's numbers.
  std::vector<Reading> other_readings() const override;

 private:
  sim::Pose pose_at(std::int64_t t_ns) const;

  CameraPoses poses_;
  std::optional<Vector3d> up_W_;
  bool may_be_misread_;
  std::optional<CameraPose> last_;
};

/// The camera's poses at the times of states and of frames, with z up. Between two states
/// velocities are linear. \param states by time, at least one. \param frames_ns within their time.
CameraPoses poses_along(const std::vector<NavigationState>& states,
                        const std::vector<std::int64_t>& frames_ns, const sim::Pose& T_BC);

}  // namespace lcs::replay
