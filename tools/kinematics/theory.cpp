#include "tools/kinematics/theory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace lcs::kinematics {
namespace {

double squared(double value) {
  return value * value;
}

/// Largest value of an error that grows with the distance from the centre.
template <class Error>
double worst_in_corners(const sim::Pinhole& camera, const Error& error) {
  double worst = 0;
  for (const double x : {0.0, camera.width_px - 1.0}) {
    for (const double y : {0.0, camera.height_px - 1.0}) {
      worst = std::max(worst, error(Vec2(Vec2(x, y) - camera.centre_px)).norm());
    }
  }
  return worst;
}

/// Variances, (m/s)^2, of a velocity corrected by odometry with white noise, in steady state: the
/// Kalman filter of v' = a + n_a, a' = n with n of density q^2 = s_ba^2 + g^2 s_g^2 (both appear as
/// an unknown acceleration) has P = sqrt(R (s_a^2 + 2 q sqrt(R))), where R = noise^2 / rate, and
/// the gains k1 = P / R, k2 = q / sqrt(R). The gyro's random walk is neglected: it is slower and
/// smaller.
///
/// Vertically, tilt has no effect (q = s_ba) and wheels read exactly 0, so that P lacks the part of
/// the odometry's noise, R (k1^2 + k2) / (2 k1).
/// \return of each horizontal axis, and of the vertical one.
Eigen::Vector2d odometry_held_velocity(const scenario::ImuNoise& noise,
                                       const scenario::Odometry& odometry, double gravity_mps2) {
  const double R = squared(odometry.noise_mps) / odometry.rate_hz;
  const auto variance = [&](double q) {
    return std::sqrt(R * (squared(noise.accelerometer_noise_density) + 2 * q * std::sqrt(R)));
  };
  const double horizontal_mps2 = variance(
      std::hypot(noise.accelerometer_random_walk, gravity_mps2 * noise.gyroscope_noise_density));
  const double q = noise.accelerometer_random_walk;
  const double P = variance(q);
  if (!(P > 0)) return {horizontal_mps2, 0};
  const double k1 = P / R, k2 = q / std::sqrt(R);
  return {horizontal_mps2, P - R * (k1 * k1 + k2) / (2 * k1)};
}

}  // namespace

Vec2 second_order_rotation(const Vec2& x_px, const Eigen::Vector3d& w_rad, double focal_px) {
  // A ray h(e) = h0 + e h1 + e^2 h2 with z = 1 at e = 0 meets the image at h_xy / h_z. The e^2
  // term:
  const Eigen::Vector3d h0(x_px.x() / focal_px, x_px.y() / focal_px, 1);
  const Eigen::Vector3d h1 = -w_rad.cross(h0);
  const Eigen::Vector3d h2 = 0.5 * w_rad.cross(w_rad.cross(h0));
  return focal_px * (h2.head<2>() - h1.head<2>() * h1.z() - h0.head<2>() * h2.z() +
                     h0.head<2>() * squared(h1.z()));
}

double first_order_limit_rad(const sim::Pinhole& camera, int axis, double bound_px) {
  // px per rad^2
  const double worst = worst_in_corners(camera, [&](const Vec2& x) {
    return second_order_rotation(x, Eigen::Vector3d::Unit(axis), camera.focal_px);
  });
  return std::sqrt(bound_px / worst);
}

double printed_limit_rad(const sim::Pinhole& camera, int axis, double bound_px, double told_sign) {
  const double worst = worst_in_corners(
      camera, [&](const Vec2& x) { return printed_slope(x, axis, camera.focal_px, told_sign); });
  return bound_px / worst;
}

Vec2 printed_slope(const Vec2& x_px, int axis, double focal_px, double told_sign) {
  const double x = x_px.x(), y = x_px.y(), f = focal_px;
  Eigen::Matrix<double, 2, 3> printed;
  printed << x * y / f, f - x * x / f, y, f, (x * y - y * y) / f, x;
  return told_sign * printed.col(axis) - rotation_jacobian(x_px, focal_px).col(axis);
}

Eigen::Matrix<double, 2, 3> rotation_jacobian(const Vec2& x_px, double focal_px) {
  const double x = x_px.x(), y = x_px.y(), f = focal_px;
  Eigen::Matrix<double, 2, 3> J;
  J << x * y / f, -(f + x * x / f), y, f + y * y / f, -x * y / f, -x;
  return J;
}

Eigen::Matrix<double, 2, 3> velocity_jacobian(const Vec2& x_px, double focal_px, double depth_m,
                                              double dt_s) {
  Eigen::Matrix<double, 2, 3> G;
  G << -focal_px, 0, x_px.x(), 0, -focal_px, x_px.y();
  return G * (dt_s / depth_m);
}

double mount_rms_px(const sim::Pinhole& camera, const std::vector<Landmark>& landmarks,
                    const Eigen::Vector3d& step_C_m, const Eigen::Vector3d& turn_C_rad, int axis,
                    double error_rad) {
  const Eigen::Vector3d error = error_rad * Eigen::Vector3d::Unit(axis);
  const Eigen::Vector3d step_wrong_m = step_C_m.cross(error), turn_wrong = turn_C_rad.cross(error);
  double sum = 0;
  for (const Landmark& landmark : landmarks) {
    const Vec2 x = landmark.before_px - camera.centre_px;
    sum += (velocity_jacobian(x, camera.focal_px, landmark.depth_after_m, 1) * step_wrong_m +
            rotation_jacobian(x, camera.focal_px) * turn_wrong)
               .squaredNorm();
  }
  return std::sqrt(sum / static_cast<double>(landmarks.size()));
}

Drift dead_reckoning_drift(const scenario::ImuNoise& noise, double gravity_mps2, double t_s) {
  const double t = t_s;
  const double g_n = squared(noise.gyroscope_noise_density);
  const double g_w = squared(noise.gyroscope_random_walk);
  const double g_0 = squared(noise.gyroscope_turn_on_bias_radps);
  Drift drift;
  drift.attitude_rad2 = g_n * t + g_w * t * t * t / 3 + g_0 * t * t;
  drift.velocity_vertical_mps2 = squared(noise.accelerometer_noise_density) * t +
                                 squared(noise.accelerometer_random_walk) * t * t * t / 3 +
                                 squared(noise.accelerometer_turn_on_bias_mps2) * t * t;
  drift.velocity_horizontal_mps2 =
      drift.velocity_vertical_mps2 +
      squared(gravity_mps2) *
          (g_n * t * t * t / 3 + g_w * std::pow(t, 5) / 20 + g_0 * std::pow(t, 4) / 4);
  return drift;
}

Eigen::Vector3d velocity_variance_B(const scenario::Scenario& scenario, double gravity_mps2,
                                    double speed_mps, double t_s) {
  const scenario::Odometry& odometry = scenario.odometry;
  if (odometry.enabled) {
    const Eigen::Vector2d held = odometry_held_velocity(scenario.imu.noise, odometry, gravity_mps2);
    return {held.x() + squared(odometry.scale_error * speed_mps), held.x(), held.y()};
  }
  const Drift drift = dead_reckoning_drift(scenario.imu.noise, gravity_mps2, t_s);
  const double aside = squared(speed_mps) * drift.attitude_rad2;
  return {drift.velocity_horizontal_mps2, drift.velocity_horizontal_mps2 + aside,
          drift.velocity_vertical_mps2 + aside};
}

double odometry_held_tilt(const scenario::ImuNoise& noise, double gravity_mps2, double t_s) {
  const double tilt = dead_reckoning_drift(noise, gravity_mps2, t_s).attitude_rad2;
  const double bias = squared(noise.accelerometer_random_walk) * t_s +
                      squared(noise.accelerometer_turn_on_bias_mps2);
  const double sum = squared(gravity_mps2) * tilt + bias;
  return sum > 0 ? tilt * bias / sum : 0;
}

double image_rms_px(const sim::Pinhole& camera, const std::vector<Landmark>& landmarks,
                    const Eigen::Vector3d& attitude_rad2, const Eigen::Vector3d& velocity_mps2,
                    double dt_s) {
  double sum = 0;
  for (const Landmark& landmark : landmarks) {
    const Vec2 x = landmark.before_px - camera.centre_px;
    const auto J = rotation_jacobian(x, camera.focal_px);
    const auto G = velocity_jacobian(x, camera.focal_px, landmark.depth_after_m, dt_s);
    sum += (J * attitude_rad2.asDiagonal() * J.transpose()).trace() +
           (G * velocity_mps2.asDiagonal() * G.transpose()).trace();
  }
  return std::sqrt(sum / static_cast<double>(landmarks.size()));
}

double gyro_turn_variance(const scenario::ImuNoise& noise, double imu_rate_hz, double dt_s) {
  const double readings = std::max(1.0, imu_rate_hz * dt_s);
  return squared(noise.gyroscope_noise_density) * dt_s * (1 - 0.5 / readings);
}

}  // namespace lcs::kinematics
