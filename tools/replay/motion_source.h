/// \file
/// Sources of the camera's motion from frame to frame of a recording; and the start of dead
/// reckoning from the first readings of an IMU: the upright direction, and at rest the biases.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "filter/ego_motion/estimator.h"
#include "filter/ego_motion/intake.h"
#include "scenarios/scenario.h"
#include "sim/base/rotation.h"
#include "sim/imu/imu.h"
#include "sim/simulation.h"
#include "tools/bench/ego_motion_feed.h"

namespace lcs::replay {

using Eigen::Vector3d;
class Tally;
struct Recorded;

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

// ---- The start of dead reckoning

/// State of the body, with the biases of its IMU.
struct TrueState : NavigationState {
  Vector3d gyro_bias_radps = Vector3d::Zero();
  Vector3d accel_bias_mps2 = Vector3d::Zero();
};

struct Rest {
  /// At the first reading, upright by the accelerometer. The bias of that is along gravity only:
  /// one across it is indistinguishable from a tilt, and is taken for one.
  TrueState start;
  std::int64_t until_ns = 0;
  bool moved = false;  ///< the readings contradict the given duration of rest
};

/// \param readings by time.
/// \param said_s duration of rest from the first reading on, in seconds; absent: as long as the
///   readings are constant up to sensor noise, which must be a second at least.
/// \return absent if no duration is given and the IMU is not at rest.
std::optional<Rest> rest_at_start(std::span<const sim::ImuSample> readings,
                                  std::optional<double> said_s, double gravity_mps2);

/// Up and rate at the first reading, by the readings of half a second. Each is the mean of the
/// middle half of the values, so that a bump or a wrong reading does not count.
struct Beginning {
  Vector3d up_S_mps2 = Vector3d::Zero();     ///< turned back to the first reading by the gyroscope
  Vector3d rate_S_radps = Vector3d::Zero();  ///< of the readings as they are
  int count = 0;                             ///< of the readings
  /// S is held still: the rate is one that a gyroscope's bias can have.
  bool is_still() const;
};

/// \param readings by time, from the start on; at least one.
Beginning beginning_of(std::span<const sim::ImuSample> readings);

/// The start at the first reading, and what is told of it: upright by the accelerometer, at rest
/// for the given or detected time, else at the given speed along the optical axis. \param readings
/// by time, at least one. \param is_upright the body's z is up unless a rest says
///   more exactly where up is.
TrueState start_of(std::span<const sim::ImuSample> readings, const scenario::RecordingSource& asked,
                   const Eigen::Matrix3d& R_BC, double gravity_mps2, bool is_upright, Tally& tally);

/// Sets the motion by dead reckoning from the start on, without its biases.
/// \param calibration without the start. \param readings from its time on, which is 0.
void move_from(const TrueState& start, sim::Calibration calibration, SensorReadings readings,
               Recorded& recorded);

}  // namespace lcs::replay
