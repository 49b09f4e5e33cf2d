/// \file
/// Theoretical errors of the experiments, for the same camera.
#pragma once

#include "scenarios/scenario.h"
#include "tools/kinematics/points.h"

namespace lcs::kinematics {

/// Error of the first-order rotation to second order, px: the terms of x' ~ exp(-[w]) x of second
/// order in w, which the first-order field lacks. `x_px` from the principal point; `w_rad` in the
/// interval. With t = x/f, for a pan by w: x (1 + t^2) w^2 along x and y (1/2 + t^2) w^2 along y,
/// nothing at the centre, where the error is of third order, f w^3 / 3; for a roll: |x| w^2 / 2.
Vec2 second_order_rotation(const Vec2& x_px, const Eigen::Vector3d& w_rad, double focal_px);

/// Angle about an axis at which the second-order error reaches `bound_px` somewhere in the image,
/// rad.
double first_order_limit_rad(const sim::Pinhole& camera, int axis, double bound_px);

/// Error of the printed rotation to first order, px per rad: its difference from the field.
/// \param told_sign of the rate given to the model.
Vec2 printed_slope(const Vec2& x_px, int axis, double focal_px, double told_sign = 1);

/// Columns: displacement of a point, px per rad of rotation about x, y and z.
Eigen::Matrix<double, 2, 3> rotation_jacobian(const Vec2& x_px, double focal_px);

/// Columns: displacement of a point at `depth_m`, px per 1 m/s along x, y and z over `dt_s`.
Eigen::Matrix<double, 2, 3> velocity_jacobian(const Vec2& x_px, double focal_px, double depth_m,
                                              double dt_s);

/// First-order error, px, root mean square over landmarks, of a camera mounted `error_rad` off
/// about an axis: step d and turn w are given in other axes, off by d x error and w x error.
double mount_rms_px(const sim::Pinhole& camera, const std::vector<Landmark>& landmarks,
                    const Eigen::Vector3d& step_C_m, const Eigen::Vector3d& turn_C_rad, int axis,
                    double error_rad);

/// Angle about an axis at which the printed rotation's first-order error reaches `bound_px`
/// somewhere in the image, rad.
double printed_limit_rad(const sim::Pinhole& camera, int axis, double bound_px, double told_sign);

/// Errors of the strapdown integration of an IMU that is at rest, or drives straight on, after
/// `t_s`: variances, each of one axis, of attitude (rad^2) and velocity ((m/s)^2).
///
/// With noise n, random walk b and turn-on bias b0 of the gyro, attitude phi' = n + b + b0. The
/// accelerometer has errors of the same form, and tilt turns gravity g into the horizontal:
/// v' = n_a + b_a + g phi.
struct Drift {
  double attitude_rad2 = 0;             ///< s_g^2 t + s_bg^2 t^3/3 + b0^2 t^2
  double velocity_horizontal_mps2 = 0;  ///< the vertical one + g^2 (s_g^2 t^3/3 + s_bg^2 t^5/20 +
                                        ///< b0^2 t^4/4)
  double velocity_vertical_mps2 = 0;    ///< s_a^2 t + s_ba^2 t^3/3 + a0^2 t^2
};
Drift dead_reckoning_drift(const scenario::ImuNoise& noise, double gravity_mps2, double t_s);

/// Variances, (m/s)^2, of the velocity forwards, to the left and upwards, after driving straight
/// ahead for `t_s` from a known start: corrected by the scenario's odometry, or by dead reckoning,
/// where a heading or pitch error diverts part of the speed.
Eigen::Vector3d velocity_variance_B(const scenario::Scenario& scenario, double gravity_mps2,
                                    double speed_mps, double t_s);

/// Variance, rad^2, about each horizontal axis, of a tilt with odometry: tilt and accelerometer
/// bias are observable only through their common force g phi + b. With prior variances V_phi and
/// V_b and a known sum, the remaining variance is V_phi V_b / (g^2 V_phi + V_b). Their histories
/// differ, which helps slightly: this is about an upper bound.
double odometry_held_tilt(const scenario::ImuNoise& noise, double gravity_mps2, double t_s);

/// Root mean square over landmarks, px, of the errors in one interval due to independent errors of
/// attitude and velocity. Variances of each axis of C: rad^2, (m/s)^2.
double image_rms_px(const sim::Pinhole& camera, const std::vector<Landmark>& landmarks,
                    const Eigen::Vector3d& attitude_rad2, const Eigen::Vector3d& velocity_mps2,
                    double dt_s);

/// Variance, rad^2, of the turn within an interval due to a gyro's white noise, each axis. The ends
/// of the interval count half, so that n - 1/2 of its n readings do.
double gyro_turn_variance(const scenario::ImuNoise& noise, double imu_rate_hz, double dt_s);

}  // namespace lcs::kinematics
