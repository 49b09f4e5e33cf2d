/// \file
/// The camera's motion between two frames, estimated from an IMU and wheel odometry.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "filter/ego_motion/imu_watch.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/types/diagnostics.h"

namespace lcs {

/// rad: standard deviation of the rotation about each axis after `dt_s` without gyro readings.
double unseen_turn_rad(double dt_s);

/// Rotations of the sensors and their lever arms, in the rover's frame B. R_BC maps C to B.
struct Mounting {
  Eigen::Matrix3d R_BC = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_BC_m = Eigen::Vector3d::Zero();
  Eigen::Matrix3d R_BS = Eigen::Matrix3d::Identity();
  Eigen::Vector3d p_BS_m = Eigen::Vector3d::Zero();
  bool on_ground = false;  ///< the origin of B stays on the ground
};

/// Expected sensor noise; used only to weight odometry against the IMU.
struct EgoMotionNoise {
  double gyro_density = 1.7e-4;   ///< rad/s/sqrt(Hz)
  double gyro_walk = 2.0e-5;      ///< rad/s^2/sqrt(Hz)
  double accel_density = 2.0e-3;  ///< m/s^2/sqrt(Hz)
  double accel_walk = 3.0e-3;     ///< m/s^3/sqrt(Hz)
  double odometry_mps = 0.02;     ///< standard deviation of one odometry velocity, per axis
  double odometry_radps = 0.05;   ///< standard deviation of a yaw rate by the wheels
  /// \name Standard deviation of each bias at the start, per axis.
  ///@{
  double gyro_turn_on_bias = 1e-5;   ///< rad/s
  double accel_turn_on_bias = 1e-3;  ///< m/s^2
  ///@}
};

/// Strapdown integration of gyro and accelerometer from a known start, in the world frame W (z up,
/// gravity along -z). An error-state Kalman filter on (attitude, velocity, gyro bias, accelerometer
/// bias) fuses wheel odometry, if any; else it is dead reckoning. While the IMU is silent, frozen
/// or saturated, its last reading is held and odometry gets more weight.
///
/// Slipping wheels report a wrong velocity. If odometry has a yaw rate, each reading is weighted by
/// the probability of grip, from earlier readings, the gyro and the velocity (probabilistic data
/// association, two-state Markov chain). When a slip is detected, the estimator returns to a state
/// of half a second to one second before, propagated by the IMU alone. Slips with a correct yaw
/// rate, as when both wheels slip alike, are detected later or not at all.
///
/// Bad readings never throw: they are dropped and counted. Frames define the clock. A frame older
/// than the last, or far ahead, has no motion and changes nothing. If a second one agrees with it,
/// the clock was set, and the estimator continues from there.
class EgoMotionEstimator {
 public:
  struct Start {
    std::int64_t t_ns = 0;
    Eigen::Matrix3d R_WB = Eigen::Matrix3d::Identity();
    Eigen::Vector3d v_WB_mps = Eigen::Vector3d::Zero();
    double gravity_mps2 = 9.81;
  };

  /// \throws std::invalid_argument for negative or non-finite values and invalid rotations.
  EgoMotionEstimator(const Mounting& mounting, const EgoMotionNoise& noise, const Start& start);

  /// A reading of the IMU in its frame S: the mean over the time since the reading before. Times do
  /// not decrease.
  void add_imu(std::int64_t t_ns, const Eigen::Vector3d& gyro_radps,
               const Eigen::Vector3d& accel_mps2);

  /// Velocity of the rover's origin in B from its wheels, and yaw rate (ccw) from their difference,
  /// if available. Integrates up to `t_ns` first.
  void add_odometry(std::int64_t t_ns, const Eigen::Vector3d& velocity_B_mps,
                    std::optional<double> yaw_rate_radps = std::nullopt);

  /// Integrates up to a frame's time. \return the motion since the last frame; for a frame with a
  /// wrong time only `dt_s`, negative or above `kLongestStep_s`.
  EgoMotion frame(std::int64_t t_ns);

  /// The ground at the current time: level, through the origin of B. Absent if that is not on the
  /// ground, or the camera is not above it.
  std::optional<Ground> ground() const;

  const Eigen::Matrix3d& R_WS() const { return now_.R_WS; }
  const Eigen::Vector3d& v_WS_mps() const { return now_.v_WS; }
  /// Probability of slip at the last odometry reading; 0 if that had no yaw rate.
  double chance_of_slip() const { return slip_; }
  /// Counts of the faults in the readings so far.
  const Diagnostics& diagnostics() const { return diagnostics_; }

 private:
  using Matrix12 = Eigen::Matrix<double, 12, 12>;
  struct State {
    Eigen::Matrix3d R_WS;
    Eigen::Vector3d v_WS;
    Eigen::Vector3d gyro_bias = Eigen::Vector3d::Zero();
    Eigen::Vector3d accel_bias = Eigen::Vector3d::Zero();
    Matrix12 covariance = Matrix12::Zero();  ///< of (attitude in W, velocity in W, biases)
    Eigen::Matrix3d R_WC_before = Eigen::Matrix3d::Identity();  ///< at the last frame
    Eigen::Vector3d displacement_W = Eigen::Vector3d::Zero();   ///< of the camera, since then
  };
  void measure_period(std::int64_t since_ns);
  bool is_gap(std::int64_t silent_ns) const;
  void note_gap(std::int64_t silent_ns);
  void propagate_to(std::int64_t t_ns);
  void propagate(State& state, double dt, bool silent) const;
  bool far_ahead(std::int64_t t_ns) const;
  EgoMotion frame_out_of_time(std::int64_t t_ns);
  void set_clock(std::int64_t t_ns);
  void begin_interval(std::int64_t t_ns);
  Eigen::Matrix3d R_WC(const State& state) const;
  void reset_covariance(State& state) const;
  bool slips() const { return slip_ > 0.5; }
  void go_back_if(bool slipped);
  std::optional<Fault> fault_of(std::int64_t t_ns, const Eigen::Vector3d& gyro_radps,
                                const Eigen::Vector3d& accel_mps2) const;
  void scale_past(double scale);

  Mounting mounting_;
  EgoMotionNoise noise_;
  Eigen::Vector3d gravity_W_;
  std::int64_t t_ns_;
  State now_;
  /// States of half a second before `kept_ns_` and at that time, propagated by the IMU alone since;
  /// empty if odometry has no yaw rate.
  std::vector<State> kept_;
  std::int64_t kept_ns_;
  double slip_ = 0;
  std::int64_t odometry_ns_;  ///< time of the last odometry reading
  struct Reading {
    std::int64_t t_ns;
    Eigen::Vector3d gyro, accel;
  };
  std::optional<Reading> last_;   ///< newest reading
  std::int64_t heard_ns_ = 0;     ///< time of the newest believed reading
  std::int64_t interval_ns_ = 0;  ///< time between the last two readings
  bool in_gap_ = false;           ///< the current gap has been counted
  std::int64_t period_ns_ = 0;    ///< least of max(two successive intervals)
  Diagnostics diagnostics_;
  ImuWatch watch_;
  Eigen::Vector3d dv_in_g_W_ = Eigen::Vector3d::Zero();  ///< velocity gained, maybe in g
  std::optional<std::int64_t> wrong_frame_ns_;           ///< set if the last frame's time was wrong

  std::optional<std::int64_t> last_frame_ns_;
  double unseen_turn_rad2_ = 0;  ///< its variance since the last frame
};

}  // namespace lcs
