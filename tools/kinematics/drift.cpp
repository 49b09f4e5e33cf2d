#include "tools/kinematics/drift.h"

#include <Eigen/Geometry>
#include <cmath>

#include "tools/bench/ego_motion_feed.h"
#include "tools/process/parallel.h"
#include "tools/kinematics/theory.h"

namespace lcs::kinematics {
namespace {

constexpr double kRate_hz = 1;  // at which the errors are looked at

/// Squares of the errors at one moment.
struct Squares {
  double tilt = 0, heading = 0;
  Eigen::Vector3d velocity_B = Eigen::Vector3d::Zero();
};

Squares squares_of(const EgoMotionEstimator& estimator, const sim::Observation& frame,
                   const sim::Calibration& calibration) {
  const sim::Pose& T_BS = calibration.T_BS;
  const Eigen::Matrix3d R_WB = frame.truth.now.T_WC.R * calibration.T_BC.R.transpose();
  const Eigen::Matrix3d R_WB_told = estimator.R_WS() * T_BS.R.transpose();
  const Eigen::AngleAxisd off(R_WB_told * R_WB.transpose());
  const Eigen::Vector3d off_W = off.angle() * off.axis();
  // The truth is the camera's velocity, the estimator's the IMU's: they turn as one body.
  const Eigen::Vector3d w_W = frame.truth.now.T_WC.R * frame.truth.w_C_radps;
  const Eigen::Vector3d v_WS =
      frame.truth.v_WC_mps + w_W.cross(R_WB * (T_BS.p - calibration.T_BC.p));
  const Eigen::Vector3d off_B =
      R_WB_told.transpose() * estimator.v_WS_mps() - R_WB.transpose() * v_WS;
  return {.tilt = 0.5 * off_W.head<2>().squaredNorm(),
          .heading = off_W.z() * off_W.z(),
          .velocity_B = off_B.cwiseAbs2()};
}

void expect(DriftRow& row, const StudyConfig& config, const scenario::Scenario& s,
            double gravity_mps2) {
  const Drift drift = dead_reckoning_drift(s.imu.noise, gravity_mps2, row.t_s);
  row.expected_heading_rad = std::sqrt(drift.attitude_rad2);
  if (!row.odometry) {
    // A heading or pitch that is off turns the speed aside.
    const double aside = config.speed_mps * config.speed_mps * drift.attitude_rad2;
    row.expected_tilt_rad = std::sqrt(drift.attitude_rad2);
    row.expected_forward_mps = std::sqrt(drift.velocity_horizontal_mps2);
    row.expected_lateral_mps = std::sqrt(drift.velocity_horizontal_mps2 + aside);
    row.expected_vertical_mps = std::sqrt(drift.velocity_vertical_mps2 + aside);
    return;
  }
  const HeldVelocity held = odometry_held_velocity(s.imu.noise, s.odometry, gravity_mps2);
  row.expected_tilt_rad = std::sqrt(odometry_held_tilt(s.imu.noise, gravity_mps2, row.t_s));
  row.expected_forward_mps =
      std::hypot(std::sqrt(held.horizontal_mps2), s.odometry.scale_error * config.speed_mps);
  row.expected_lateral_mps = std::sqrt(held.horizontal_mps2);
  row.expected_vertical_mps = std::sqrt(held.vertical_mps2);
}

}  // namespace

int drift_pieces(const StudyConfig& config) {
  return static_cast<int>(imus(config).size()) * 2 * config.effort.drift_seeds;
}

std::vector<DriftRow> drift_rows(const StudyConfig& config, const Tick& tick) {
  const sim::Drive ideal = sim::drive(straight_drive(config, config.effort.drift_s, kRate_hz));
  const int seeds = config.effort.drift_seeds;
  std::vector<DriftRow> rows;
  for (const NamedImu& imu : imus(config)) {
    for (const bool odometry : {false, true}) {
      const scenario::Scenario scenario = with_imu(config, imu.noise, odometry);
      std::vector<std::vector<Squares>> of_seed(static_cast<std::size_t>(seeds));
      process::for_each_parallel(
          seeds,
          [&](int i) {
            scenario::Scenario s = scenario;
            s.seed += static_cast<std::uint64_t>(i);
            const sim::Drive drive = with_noise(ideal, s);
            bench::EgoMotionFeed feed(s, drive.calibration);
            for (const sim::Observation& frame : drive.frames) {
              feed.next(frame);
              of_seed[static_cast<std::size_t>(i)].push_back(
                  squares_of(feed.estimator(), frame, drive.calibration));
            }
          },
          tick);
      for (std::size_t k = 0; k < ideal.frames.size(); ++k) {
        Squares sum;
        for (const auto& squares : of_seed) {
          sum.tilt += squares[k].tilt;
          sum.heading += squares[k].heading;
          sum.velocity_B += squares[k].velocity_B;
        }
        const Eigen::Vector3d velocity = (sum.velocity_B / seeds).cwiseSqrt();
        DriftRow row{.imu = imu.name,
                     .odometry = odometry,
                     .t_s = static_cast<double>(k) / kRate_hz,
                     .seeds = seeds,
                     .tilt_rad = std::sqrt(sum.tilt / seeds),
                     .heading_rad = std::sqrt(sum.heading / seeds),
                     .forward_mps = velocity.x(),
                     .lateral_mps = velocity.y(),
                     .vertical_mps = velocity.z()};
        expect(row, config, scenario, ideal.calibration.gravity_mps2);
        rows.push_back(row);
      }
    }
  }
  return rows;
}

}  // namespace lcs::kinematics
