#include "filter/ego_motion.h"

#include <Eigen/LU>
#include <algorithm>

namespace lcs {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

Matrix3d skew(const Vector3d& v) {
  Matrix3d m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Matrix3d exponential(const Vector3d& rotation_rad) {
  const double angle = rotation_rad.norm();
  if (angle < 1e-12) return Matrix3d::Identity() + skew(rotation_rad);
  return Eigen::AngleAxisd(angle, rotation_rad / angle).toRotationMatrix();
}

Vector3d logarithm(const Matrix3d& R) {
  const Eigen::AngleAxisd axis_angle(R);
  return axis_angle.angle() * axis_angle.axis();
}

// Blocks of the error state.
constexpr int kAttitude = 0, kVelocity = 3, kGyroBias = 6, kAccelBias = 9;

// What the given start may be off by.
constexpr double kStartAttitude_rad = 1e-3, kStartVelocity_mps = 1e-2;

// The IMU is silent once it is overdue by as many of its periods. What it then does not see: turns
// of 0.2 rad/s and accelerations of 2 m/s^2 that last for some tenths of a second.
constexpr int kSilentPeriods = 4;
constexpr double kUnseenTurn = 0.1;          // rad/s/sqrt(Hz), about the vertical
constexpr double kUnseenAcceleration = 1.0;  // m/s^2/sqrt(Hz)

}  // namespace

EgoMotionEstimator::EgoMotionEstimator(const Mounting& mounting, const EgoMotionNoise& noise,
                                       const Start& start)
    : mounting_(mounting),
      noise_(noise),
      gravity_W_(0, 0, -start.gravity_mps2),
      t_ns_(start.t_ns),
      R_WS_(start.R_WB * mounting.R_BS),
      v_WS_(start.v_WB_mps) {
  const auto block = [&](int first, double deviation) {
    covariance_.diagonal().segment<3>(first).setConstant(deviation * deviation);
  };
  block(kAttitude, kStartAttitude_rad);
  block(kVelocity, kStartVelocity_mps);
  block(kGyroBias, noise.gyro_turn_on_bias);
  block(kAccelBias, noise.accel_turn_on_bias);
}

void EgoMotionEstimator::add_imu(std::int64_t t_ns, const Vector3d& gyro_radps,
                                 const Vector3d& accel_mps2) {
  if (t_ns < t_ns_ || !gyro_radps.allFinite() || !accel_mps2.allFinite()) {
    ++dropped_;
    return;
  }
  const Reading reading{t_ns, gyro_radps, accel_mps2};
  if (!last_) {
    // The start gives the velocity of the rover's origin; the IMU sits on a lever.
    v_WS_ += R_WS_ * gyro_radps.cross(mounting_.R_BS.transpose() * mounting_.p_BS_m);
    last_ = reading;
  }
  // Over the interval that ends with this reading both rates are taken to change linearly.
  last_->gyro = 0.5 * (last_->gyro + gyro_radps);
  last_->accel = 0.5 * (last_->accel + accel_mps2);
  const std::int64_t since_ns = t_ns - last_->t_ns;
  if (since_ns > 0) period_ns_ = period_ns_ == 0 ? since_ns : std::min(period_ns_, since_ns);
  propagate_to(t_ns);
  last_ = reading;
}

void EgoMotionEstimator::propagate_to(std::int64_t t_ns) {
  const double dt = static_cast<double>(t_ns - t_ns_) * 1e-9;
  if (dt <= 0 || !last_) return;
  const Vector3d rotation = (last_->gyro - gyro_bias_) * dt;
  const Vector3d specific_force = last_->accel - accel_bias_;
  const Matrix3d R_mid = R_WS_ * exponential(0.5 * rotation);
  const Vector3d a_W = R_mid * specific_force + gravity_W_;
  const Matrix3d R_old = R_WS_;
  const Vector3d v_old = v_WS_;

  R_WS_ = R_WS_ * exponential(rotation);
  v_WS_ += a_W * dt;
  const Vector3d lever_S = mounting_.R_BS.transpose() * (mounting_.p_BC_m - mounting_.p_BS_m);
  displacement_W_ += 0.5 * (v_old + v_WS_) * dt + (R_WS_ - R_old) * lever_S;
  t_ns_ = t_ns;

  Matrix12 F = Matrix12::Identity();
  F.block<3, 3>(kAttitude, kGyroBias) = -R_mid * dt;
  F.block<3, 3>(kVelocity, kAttitude) = -skew(R_mid * specific_force) * dt;
  F.block<3, 3>(kVelocity, kAccelBias) = -R_mid * dt;
  covariance_ = F * covariance_ * F.transpose();
  const auto add_noise = [&](int first, double density) {
    covariance_.diagonal().segment<3>(first).array() += density * density * dt;
  };
  add_noise(kAttitude, noise_.gyro_density);
  add_noise(kVelocity, noise_.accel_density);
  add_noise(kGyroBias, noise_.gyro_walk);
  add_noise(kAccelBias, noise_.accel_walk);
  if (period_ns_ > 0 && t_ns - last_->t_ns > kSilentPeriods * period_ns_) {
    covariance_(kAttitude + 2, kAttitude + 2) += kUnseenTurn * kUnseenTurn * dt;
    add_noise(kVelocity, kUnseenAcceleration);
  }
}

void EgoMotionEstimator::add_odometry(std::int64_t t_ns, const Vector3d& velocity_B_mps) {
  if (t_ns < t_ns_ || !velocity_B_mps.allFinite() || !last_) {
    ++dropped_;
    return;
  }
  propagate_to(t_ns);
  const Vector3d lever_S = mounting_.R_BS.transpose() * -mounting_.p_BS_m;
  const Vector3d rate_S = last_->gyro - gyro_bias_;
  const Matrix3d R_BW = mounting_.R_BS * R_WS_.transpose();
  const Vector3d expected_B = R_BW * v_WS_ + mounting_.R_BS * rate_S.cross(lever_S);

  Eigen::Matrix<double, 3, 12> H = Eigen::Matrix<double, 3, 12>::Zero();
  H.block<3, 3>(0, kAttitude) = R_BW * skew(v_WS_);
  H.block<3, 3>(0, kVelocity) = R_BW;
  H.block<3, 3>(0, kGyroBias) = mounting_.R_BS * skew(lever_S);
  const Matrix3d S = H * covariance_ * H.transpose() +
                     Matrix3d::Identity() * (noise_.odometry_mps * noise_.odometry_mps);
  const Eigen::Matrix<double, 12, 3> gain = covariance_ * H.transpose() * S.inverse();
  const Eigen::Matrix<double, 12, 1> error = gain * (velocity_B_mps - expected_B);

  // The whole history turns with the attitude: a correction is not a motion of this frame.
  const Matrix3d correction = exponential(error.segment<3>(kAttitude));
  R_WS_ = correction * R_WS_;
  displacement_W_ = correction * displacement_W_;
  if (last_frame_) last_frame_->R_WC = correction * last_frame_->R_WC;
  v_WS_ += error.segment<3>(kVelocity);
  gyro_bias_ += error.segment<3>(kGyroBias);
  accel_bias_ += error.segment<3>(kAccelBias);
  // Joseph form: stays symmetric and positive.
  const Matrix12 I_KH = Matrix12::Identity() - gain * H;
  covariance_ = (I_KH * covariance_ * I_KH.transpose() +
                 gain * gain.transpose() * (noise_.odometry_mps * noise_.odometry_mps))
                    .eval();
}

std::optional<Ground> EgoMotionEstimator::ground() const {
  if (!mounting_.on_ground) return std::nullopt;
  const Matrix3d R_WB = R_WS_ * mounting_.R_BS.transpose();
  const double height_m = (R_WB * mounting_.p_BC_m).z();
  if (!(height_m > 0)) return std::nullopt;
  return Ground{.up_C = (R_WB * mounting_.R_BC).row(2), .height_m = height_m};
}

EgoMotion EgoMotionEstimator::frame(std::int64_t t_ns) {
  propagate_to(t_ns);
  const Matrix3d R_WC = R_WS_ * mounting_.R_BS.transpose() * mounting_.R_BC;
  EgoMotion motion;
  motion.ground = ground();
  if (last_frame_ && t_ns > last_frame_->t_ns) {
    motion.dt_s = static_cast<double>(t_ns - last_frame_->t_ns) * 1e-9;
    motion.R_cur_prev = R_WC.transpose() * last_frame_->R_WC;
    motion.v_C_mps = R_WC.transpose() * displacement_W_ / motion.dt_s;
    motion.w_C_radps = -logarithm(motion.R_cur_prev) / motion.dt_s;
  }
  last_frame_ = Frame{t_ns, R_WC};
  displacement_W_.setZero();
  return motion;
}

}  // namespace lcs
