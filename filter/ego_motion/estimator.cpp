#include "filter/ego_motion/estimator.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "filter/ego_motion/intake.h"
#include "filter/kinematics/rotation.h"

namespace lcs {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// First indices of the blocks of the error state.
constexpr int kAttitude = 0, kVelocity = 3, kGyroBias = 6, kAccelBias = 9;

// Standard deviations of the given start.
constexpr double kStartAttitude_rad = 1e-3, kStartVelocity_mps = 1e-2;

// The IMU is silent once it is overdue by this many of its periods. Its unmeasured motion is
// modelled as turns of 0.2 rad/s and accelerations of 2 m/s^2 for some tenths of a second.
constexpr int kSilentPeriods = 4;
constexpr double kUnseenTurn = 0.1;          // rad/s/sqrt(Hz), about the vertical
constexpr double kUnseenAcceleration = 1.0;  // m/s^2/sqrt(Hz)

// Rate at which wheels begin or cease to slip, and the variance of odometry in slip, relative to
// grip. Chosen by F1 on 44 yards of `train`; a third of the rate or twice the variance changed F1
// by .003.
constexpr double kSlipRate_ps = 1, kSlipVariance = 2;
// After a slip is detected the estimator goes back by once to twice this time.
constexpr double kHiddenSlip_s = 0.5;

// Beyond the range of any sensor.
constexpr double kMostRate_radps = 100, kMostForce_mps2 = 2000;

// Variances above this mean that nothing is known; the cap prevents overflow.
constexpr double kMostVariance = 1e12;

/// Signed seconds, as doubles: an integer difference of times of two clocks may overflow.
double seconds_from(std::int64_t from_ns, std::int64_t to_ns) {
  return (static_cast<double>(to_ns) - static_cast<double>(from_ns)) * 1e-9;
}

void require(bool holds, const char* what) {
  if (!holds) throw std::invalid_argument(std::string("the estimator of ego-motion needs ") + what);
}

/// Probability of slip after a reading, from its value `since_s` before. `miss2` is the squared
/// error of the reading, in variances of wheels that grip.
double slip_after(double slip, double since_s, double miss2) {
  constexpr int kValues = 4;  // velocity and yaw rate
  const double turned = std::clamp(kSlipRate_ps * since_s, 0.0, 0.5);
  const double before = slip * (1 - turned) + (1 - slip) * turned;
  // log likelihood ratio of two normals whose variances differ by the factor k
  const double evidence =
      0.5 * (miss2 * (1 - 1 / kSlipVariance) - kValues * std::log(kSlipVariance));
  // For a large error at the very start both terms below would be 0.
  return before > 0 ? before / (before + (1 - before) * std::exp(-evidence)) : 0;
}

void check(const Mounting& mounting, const EgoMotionNoise& noise,
           const EgoMotionEstimator::Start& start) {
  for (const Matrix3d* R : {&mounting.R_BC, &mounting.R_BS, &start.R_WB}) {
    require(R->allFinite() && is_rotation(*R), "rotations");
  }
  require(mounting.p_BC_m.allFinite() && mounting.p_BS_m.allFinite(), "lever arms that are finite");
  require(
      start.v_WB_mps.allFinite() && std::isfinite(start.gravity_mps2) && start.gravity_mps2 >= 0,
      "a velocity and a gravity to start from");
  for (const double deviation : {noise.gyro_density, noise.gyro_walk, noise.accel_density,
                                 noise.accel_walk, noise.odometry_mps, noise.odometry_radps,
                                 noise.gyro_turn_on_bias, noise.accel_turn_on_bias}) {
    require(std::isfinite(deviation) && deviation >= 0, "noise that is finite and not negative");
  }
  require(noise.odometry_mps > 0 && noise.odometry_radps > 0, "odometry with noise");
}

}  // namespace

double unseen_turn_rad(double dt_s) {
  return kUnseenTurn * std::sqrt(dt_s);
}

EgoMotionEstimator::EgoMotionEstimator(const Mounting& mounting, const EgoMotionNoise& noise,
                                       const Start& start)
    : mounting_(mounting),
      noise_(noise),
      gravity_W_(0, 0, -start.gravity_mps2),
      t_ns_(start.t_ns),
      kept_ns_(start.t_ns),
      odometry_ns_(start.t_ns),
      watch_({.gravity_mps2 = start.gravity_mps2,
              .noisy = noise.gyro_density > 0 && noise.accel_density > 0}) {
  check(mounting, noise, start);
  now_.R_WS = start.R_WB * mounting.R_BS;
  now_.v_WS = start.v_WB_mps;
  reset_covariance(now_);
}

void EgoMotionEstimator::reset_covariance(State& state) const {
  state.covariance.setZero();
  const auto block = [&](int first, double deviation) {
    state.covariance.diagonal().segment<3>(first).setConstant(deviation * deviation);
  };
  block(kAttitude, kStartAttitude_rad);
  block(kVelocity, kStartVelocity_mps);
  block(kGyroBias, noise_.gyro_turn_on_bias);
  block(kAccelBias, noise_.accel_turn_on_bias);
}

bool EgoMotionEstimator::far_ahead(std::int64_t t_ns) const {
  return seconds_from(t_ns_, t_ns) > kLongestStep_s;
}

std::optional<Fault> EgoMotionEstimator::fault_of(std::int64_t t_ns, const Vector3d& gyro_radps,
                                                  const Vector3d& accel_mps2) const {
  if (!gyro_radps.allFinite() || !accel_mps2.allFinite()) return Fault::imu_not_finite;
  if (!(gyro_radps.norm() <= kMostRate_radps && accel_mps2.norm() <= kMostForce_mps2)) {
    return Fault::imu_too_large;
  }
  if (t_ns < t_ns_) return Fault::imu_out_of_order;
  if (far_ahead(t_ns)) return Fault::imu_jump;
  return std::nullopt;
}

/// Rescales readings that were integrated before they were found to be in g.
void EgoMotionEstimator::scale_past(double scale) {
  const Vector3d missed = (scale - 1) * dv_in_g_W_;
  now_.v_WS += missed;
  for (State& state : kept_) state.v_WS += missed;
}

void EgoMotionEstimator::add_imu(std::int64_t t_ns, const Vector3d& gyro_radps,
                                 const Vector3d& accel_mps2) {
  if (const std::optional<Fault> fault = fault_of(t_ns, gyro_radps, accel_mps2)) {
    diagnostics_.add(*fault);
    return;
  }
  const ImuWatch::Finding finding = watch_.look(gyro_radps, accel_mps2, diagnostics_);
  const Vector3d accel = finding.accel_scale * accel_mps2;
  if (!last_) {
    // The start gives the velocity of the rover's origin; the lever arm adds the IMU's part.
    now_.v_WS += now_.R_WS * gyro_radps.cross(mounting_.R_BS.transpose() * mounting_.p_BS_m);
    last_ = {t_ns, gyro_radps, accel};
    heard_ns_ = t_ns;
  }
  if (finding.begins_in_g) scale_past(finding.accel_scale);
  const std::int64_t since_ns = t_ns - last_->t_ns;
  measure_period(since_ns);
  // A reading is the mean over its period. The rest of a gap before it is not measured.
  if (is_gap(since_ns)) propagate_to(t_ns - period_ns_);
  last_ = {t_ns, gyro_radps, accel};
  if (watch_.in_g() == 0 || watch_.in_g() == ImuWatch::kInG) {
    dv_in_g_W_.setZero();
  } else {
    dv_in_g_W_ += now_.R_WS * accel * seconds_from(t_ns_, t_ns);
  }
  propagate_to(t_ns);
  if (finding.believed) heard_ns_ = t_ns;
}

bool EgoMotionEstimator::is_gap(std::int64_t silent_ns) const {
  return period_ns_ > 0 && silent_ns > kSilentPeriods * period_ns_;
}

/// Counts each gap once.
void EgoMotionEstimator::note_gap(std::int64_t silent_ns) {
  if (in_gap_ || !is_gap(silent_ns)) return;
  in_gap_ = true;
  diagnostics_.add(Fault::imu_gap);
}

/// Period: least value so far of the longer of two successive intervals; robust to a wrong time.
void EgoMotionEstimator::measure_period(std::int64_t since_ns) {
  if (since_ns <= 0) return;
  note_gap(since_ns);
  in_gap_ = false;
  if (interval_ns_ > 0) {
    const std::int64_t longer_ns = std::max(since_ns, interval_ns_);
    period_ns_ = period_ns_ == 0 ? longer_ns : std::min(period_ns_, longer_ns);
  }
  interval_ns_ = since_ns;
}

void EgoMotionEstimator::propagate_to(std::int64_t t_ns) {
  const double dt = static_cast<double>(t_ns - t_ns_) * 1e-9;
  if (dt <= 0 || !last_) return;
  t_ns_ = t_ns;
  const bool silent = is_gap(t_ns - heard_ns_);
  if (silent) unseen_turn_rad2_ += kUnseenTurn * kUnseenTurn * dt;
  propagate(now_, dt, silent);
  for (State& state : kept_) propagate(state, dt, silent);
}

void EgoMotionEstimator::propagate(State& state, double dt, bool silent) const {
  const Vector3d rotation = (last_->gyro - state.gyro_bias) * dt;
  const Vector3d specific_force = last_->accel - state.accel_bias;
  const Matrix3d R_mid = state.R_WS * exponential(0.5 * rotation);
  const Vector3d a_W = R_mid * specific_force + gravity_W_;
  const Matrix3d R_old = state.R_WS;
  const Vector3d v_old = state.v_WS;

  state.R_WS = state.R_WS * exponential(rotation);
  state.v_WS += a_W * dt;
  const Vector3d lever_S = mounting_.R_BS.transpose() * (mounting_.p_BC_m - mounting_.p_BS_m);
  state.displacement_W += 0.5 * (v_old + state.v_WS) * dt + (state.R_WS - R_old) * lever_S;

  Matrix12 F = Matrix12::Identity();
  F.block<3, 3>(kAttitude, kGyroBias) = -R_mid * dt;
  F.block<3, 3>(kVelocity, kAttitude) = -skew(R_mid * specific_force) * dt;
  F.block<3, 3>(kVelocity, kAccelBias) = -R_mid * dt;
  state.covariance = F * state.covariance * F.transpose();
  const auto add_noise = [&](int first, double density) {
    state.covariance.diagonal().segment<3>(first).array() += density * density * dt;
  };
  add_noise(kAttitude, noise_.gyro_density);
  add_noise(kVelocity, noise_.accel_density);
  add_noise(kGyroBias, noise_.gyro_walk);
  add_noise(kAccelBias, noise_.accel_walk);
  if (silent) {
    state.covariance(kAttitude + 2, kAttitude + 2) += kUnseenTurn * kUnseenTurn * dt;
    add_noise(kVelocity, kUnseenAcceleration);
  }
  if (!(state.covariance.diagonal().array() < kMostVariance).all()) reset_covariance(state);
}

void EgoMotionEstimator::add_odometry(std::int64_t t_ns, const Vector3d& velocity_B_mps,
                                      std::optional<double> yaw_rate_radps) {
  if (!(velocity_B_mps.norm() <= kMostSpeed_mps) ||
      (yaw_rate_radps && !(std::abs(*yaw_rate_radps) <= kMostRate_radps))) {
    diagnostics_.add(Fault::odometry_unusable);
    return;
  }
  if (t_ns < t_ns_ || far_ahead(t_ns) || !last_) {
    diagnostics_.add(Fault::odometry_out_of_order);
    return;
  }
  propagate_to(t_ns);
  const Vector3d lever_S = mounting_.R_BS.transpose() * -mounting_.p_BS_m;
  const Vector3d rate_S = last_->gyro - now_.gyro_bias;
  const Matrix3d R_BW = mounting_.R_BS * now_.R_WS.transpose();
  const Vector3d expected_B = R_BW * now_.v_WS + mounting_.R_BS * rate_S.cross(lever_S);

  Eigen::Matrix<double, 3, 12> H = Eigen::Matrix<double, 3, 12>::Zero();
  H.block<3, 3>(0, kAttitude) = R_BW * skew(now_.v_WS);
  H.block<3, 3>(0, kVelocity) = R_BW;
  H.block<3, 3>(0, kGyroBias) = mounting_.R_BS * skew(lever_S);
  const double noise2 = noise_.odometry_mps * noise_.odometry_mps;
  const Matrix3d S = H * now_.covariance * H.transpose() + Matrix3d::Identity() * noise2;
  const Vector3d miss = velocity_B_mps - expected_B;
  const Eigen::Matrix<double, 12, 3> gain = now_.covariance * H.transpose() * S.inverse();
  const Eigen::Matrix<double, 12, 1> whole = gain * miss;

  const bool slipped = slips();
  if (yaw_rate_radps) {
    if (kept_.empty()) kept_ = {now_, now_};
    const Eigen::RowVector3d up_S = mounting_.R_BS.row(2);
    const double turn = *yaw_rate_radps - up_S * rate_S;
    const double variance =
        noise_.odometry_radps * noise_.odometry_radps +
        (up_S * now_.covariance.block<3, 3>(kGyroBias, kGyroBias) * up_S.transpose()).value();
    slip_ = slip_after(slip_, seconds_from(odometry_ns_, t_ns),
                       miss.dot(S.inverse() * miss) + turn * turn / variance);
  } else {
    slip_ = 0;
  }
  odometry_ns_ = t_ns;
  const double grip = 1 - slip_;
  const Eigen::Matrix<double, 12, 1> error = grip * whole;

  // A correction of attitude is no motion in this frame, so it rotates the history too.
  const Matrix3d correction = exponential(error.segment<3>(kAttitude));
  now_.R_WS = correction * now_.R_WS;
  now_.displacement_W = correction * now_.displacement_W;
  now_.R_WC_before = correction * now_.R_WC_before;
  now_.v_WS += error.segment<3>(kVelocity);
  now_.gyro_bias += error.segment<3>(kGyroBias);
  now_.accel_bias += error.segment<3>(kAccelBias);
  // Joseph form, symmetric and positive; then the mixture of grip and slip.
  const Matrix12 I_KH = Matrix12::Identity() - gain * H;
  now_.covariance =
      (grip * (I_KH * now_.covariance * I_KH.transpose() + gain * gain.transpose() * noise2) +
       slip_ * now_.covariance + grip * slip_ * whole * whole.transpose())
          .eval();
  go_back_if(slipped);
}

/// Undoes odometry that was taken before the slip was detected: it has corrupted attitude and
/// biases. Returns to an earlier state propagated by the IMU alone.
void EgoMotionEstimator::go_back_if(bool slipped) {
  if (kept_.empty()) return;
  if (slips()) {
    if (!slipped) now_ = kept_.front();
  } else if (seconds_from(kept_ns_, t_ns_) >= kHiddenSlip_s) {
    kept_ = {kept_.back(), now_};
    kept_ns_ = t_ns_;
  }
}

std::optional<Ground> EgoMotionEstimator::ground() const {
  if (!mounting_.on_ground) return std::nullopt;
  const Matrix3d R_WB = now_.R_WS * mounting_.R_BS.transpose();
  const double height_m = (R_WB * mounting_.p_BC_m).z();
  if (!(height_m > 0)) return std::nullopt;
  return Ground{.up_C = (R_WB * mounting_.R_BC).row(2), .height_m = height_m};
}

Matrix3d EgoMotionEstimator::R_WC(const State& state) const {
  return state.R_WS * mounting_.R_BS.transpose() * mounting_.R_BC;
}

void EgoMotionEstimator::set_clock(std::int64_t t_ns) {
  t_ns_ = heard_ns_ = odometry_ns_ = kept_ns_ = t_ns;
  if (last_) last_->t_ns = t_ns;
}

/// Starts the interval of the next frame's motion.
void EgoMotionEstimator::begin_interval(std::int64_t t_ns) {
  last_frame_ns_ = t_ns;
  const auto begin = [&](State& state) {
    state.R_WC_before = R_WC(state);
    state.displacement_W.setZero();
  };
  begin(now_);
  for (State& state : kept_) begin(state);
  unseen_turn_rad2_ = 0;
}

/// Motion is unknown since the last frame. If a second such frame agrees with the first, the clock
/// was set.
EgoMotion EgoMotionEstimator::frame_out_of_time(std::int64_t t_ns) {
  EgoMotion motion;
  motion.dt_s = seconds_from(*last_frame_ns_, t_ns);
  const bool agrees = wrong_frame_ns_ && t_ns > *wrong_frame_ns_ &&
                      seconds_from(*wrong_frame_ns_, t_ns) <= kLongestStep_s;
  wrong_frame_ns_ = t_ns;
  if (agrees) {
    diagnostics_.add(Fault::clock_set);
    set_clock(t_ns);
    begin_interval(t_ns);
    wrong_frame_ns_.reset();
  }
  return motion;
}

EgoMotion EgoMotionEstimator::frame(std::int64_t t_ns) {
  if (last_frame_ns_ &&
      (t_ns < *last_frame_ns_ || seconds_from(*last_frame_ns_, t_ns) > kLongestStep_s)) {
    return frame_out_of_time(t_ns);
  }
  wrong_frame_ns_.reset();
  // The first frame sets the clock if the start uses another clock.
  if (!last_frame_ns_ && std::abs(seconds_from(t_ns_, t_ns)) > kLongestStep_s) set_clock(t_ns);
  if (last_) note_gap(t_ns - last_->t_ns);
  propagate_to(t_ns);
  const Matrix3d R_WC_now = R_WC(now_);
  EgoMotion motion;
  motion.ground = ground();
  motion.velocity_sigma_mps =
      std::sqrt(now_.covariance.block<3, 3>(kVelocity, kVelocity).trace() / 3);
  if (last_frame_ns_ && t_ns > *last_frame_ns_) {
    motion.dt_s = static_cast<double>(t_ns - *last_frame_ns_) * 1e-9;
    motion.R_cur_prev = R_WC_now.transpose() * now_.R_WC_before;
    motion.v_C_mps = R_WC_now.transpose() * now_.displacement_W / motion.dt_s;
    motion.w_C_radps = -logarithm(motion.R_cur_prev) / motion.dt_s;
    motion.unseen_turn_rad = std::sqrt(unseen_turn_rad2_);
  }
  begin_interval(t_ns);
  return motion;
}

}  // namespace lcs
