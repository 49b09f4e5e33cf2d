#include "tools/kinematics/study.h"

#include <Eigen/Geometry>
#include <cmath>

#include "tools/bench/ego_motion_feed.h"
#include "tools/kinematics/theory.h"
#include "tools/process/parallel.h"

namespace lcs::kinematics {
namespace {

constexpr double kRate_hz = 1;  // of the rows

using Squares = DriftErrors;  // the squared errors at one time

Squares squares_of(const EgoMotionEstimator& estimator, const sim::Observation& frame,
                   const sim::Calibration& calibration) {
  const sim::Pose& T_BS = calibration.T_BS;
  const Eigen::Matrix3d R_WB = frame.truth.now.T_WC.R * calibration.T_BC.R.transpose();
  const Eigen::Matrix3d R_WB_told = estimator.R_WS() * T_BS.R.transpose();
  const Eigen::AngleAxisd off(R_WB_told * R_WB.transpose());
  const Eigen::Vector3d off_W = off.angle() * off.axis();
  // The truth is the camera's velocity, the estimate the IMU's; both points turn with the rover.
  const Eigen::Vector3d w_W = frame.truth.now.T_WC.R * frame.truth.w_C_radps;
  const Eigen::Vector3d v_WS =
      frame.truth.v_WC_mps + w_W.cross(R_WB * (T_BS.p - calibration.T_BC.p));
  const Eigen::Vector3d off_B =
      R_WB_told.transpose() * estimator.v_WS_mps() - R_WB.transpose() * v_WS;
  return {.tilt_rad = 0.5 * off_W.head<2>().squaredNorm(),
          .heading_rad = off_W.z() * off_W.z(),
          .velocity_B_mps = off_B.cwiseAbs2()};
}

DriftErrors expected_errors(const StudyConfig& config, const scenario::Scenario& s,
                            double gravity_mps2, double t_s) {
  const double attitude_rad2 = dead_reckoning_drift(s.imu.noise, gravity_mps2, t_s).attitude_rad2;
  const double tilt_rad2 =
      s.odometry.enabled ? odometry_held_tilt(s.imu.noise, gravity_mps2, t_s) : attitude_rad2;
  return {
      .tilt_rad = std::sqrt(tilt_rad2),
      .heading_rad = std::sqrt(attitude_rad2),
      .velocity_B_mps = velocity_variance_B(s, gravity_mps2, config.speed_mps, t_s).cwiseSqrt()};
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
          sum.tilt_rad += squares[k].tilt_rad;
          sum.heading_rad += squares[k].heading_rad;
          sum.velocity_B_mps += squares[k].velocity_B_mps;
        }
        const double t_s = static_cast<double>(k) / kRate_hz;
        rows.push_back(
            {.imu = imu.name,
             .odometry = odometry,
             .t_s = t_s,
             .seeds = seeds,
             .rms = {.tilt_rad = std::sqrt(sum.tilt_rad / seeds),
                     .heading_rad = std::sqrt(sum.heading_rad / seeds),
                     .velocity_B_mps = (sum.velocity_B_mps / seeds).cwiseSqrt()},
             .expected = expected_errors(config, scenario, ideal.calibration.gravity_mps2, t_s)});
      }
    }
  }
  return rows;
}

}  // namespace lcs::kinematics
