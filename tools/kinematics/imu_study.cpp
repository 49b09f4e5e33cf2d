#include "tools/kinematics/study.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>

#include "scenarios/imu_presets.h"
#include "tools/bench/detector.h"
#include "tools/bench/ego_motion_feed.h"
#include "tools/kinematics/theory.h"
#include "tools/process/parallel.h"
#include "tools/scoring/statistics.h"

namespace lcs::kinematics {
namespace {

constexpr std::array kImuRates_hz = {1.0, 3.0, 10.0, 30.0};
constexpr std::array kImuDepths_m = {2.0, 4.0, 8.0};
constexpr std::array kRoughness_m = {0.0, 1e-3, 2.5e-3, 5e-3, 10e-3};
constexpr double kBumpyWay_m = 3.5;  // length of the rough ground beyond its centre
constexpr double kLongestBumps_s = 10;

PointSet coarse_points(const StudyConfig& config) {
  return geometric_points(config.camera, kImuDepths_m, 9, 7);
}

std::vector<double> rates(const StudyConfig& config) {
  std::vector<double> all(kImuRates_hz.begin(), kImuRates_hz.end());
  const double own = config.scenario.camera.rate_hz;
  if (std::ranges::find(all, own) == all.end()) all.push_back(own);
  std::ranges::sort(all);
  return all;
}

/// The landmarks of each frame of a drive except the first, which has no motion.
std::vector<std::vector<Landmark>> landmarks_along(const sim::Drive& drive, const PointSet& points,
                                                   const FieldParameters& field) {
  std::vector<std::vector<Landmark>> all;
  for (std::size_t k = 1; k < drive.frames.size(); ++k) {
    const sim::Pose T_CN =
        drive.frames[k - 1].truth.now.T_WC.inverse() * drive.frames[k].truth.now.T_WC;
    all.push_back(landmarks(points, T_CN, field));
  }
  return all;
}

/// The theoretical error, root mean square over the frames.
double expected_rms_px(const StudyConfig& config, const sim::Drive& drive,
                       const std::vector<std::vector<Landmark>>& seen, const scenario::Scenario& s,
                       double rate_hz, bool with_velocity) {
  const double dt = 1 / rate_hz, g = drive.calibration.gravity_mps2;
  const scenario::ImuNoise& imu = s.imu.noise;
  double sum = 0;
  for (std::size_t k = 1; k < drive.frames.size(); ++k) {
    const double t = static_cast<double>(k) * dt;
    const double bias2 = imu.gyroscope_random_walk * imu.gyroscope_random_walk * t +
                         imu.gyroscope_turn_on_bias_radps * imu.gyroscope_turn_on_bias_radps;
    const Eigen::Vector3d attitude =
        Eigen::Vector3d::Constant(gyro_turn_variance(imu, s.imu.rate_hz, dt) + bias2 * dt * dt);
    Eigen::Vector3d velocity_B = Eigen::Vector3d::Zero();
    if (with_velocity) velocity_B = velocity_variance_B(s, g, config.speed_mps, t);
    const Eigen::Matrix3d R_CB = drive.calibration.T_BC.R.transpose();
    const Eigen::Vector3d velocity_C =
        (R_CB * velocity_B.asDiagonal() * R_CB.transpose()).diagonal();
    const double rms = image_rms_px(config.camera, seen[k - 1], attitude, velocity_C, dt);
    sum += rms * rms;
  }
  return std::sqrt(sum / static_cast<double>(drive.frames.size() - 1));
}

struct Errors {
  std::vector<double> all, rotation;
};

Errors errors_along(const StudyConfig& config, const sim::Drive& drive,
                    const scenario::Scenario& scenario,
                    const std::vector<std::vector<Landmark>>& seen) {
  bench::EgoMotionFeed feed(scenario, drive.calibration);
  const Intrinsics camera = bench::intrinsics(config.camera);
  Errors result;
  for (std::size_t k = 0; k < drive.frames.size(); ++k) {
    const bench::EgoMotionFeed::Motions motions = feed.next(drive.frames[k]);
    if (k == 0) continue;
    EgoMotion turned_only = motions.told;
    turned_only.v_C_mps = motions.exact.v_C_mps;
    append(result.all, errors({camera, motions.told, field_of(config.filter)}, {}, seen[k - 1]));
    append(result.rotation,
           errors({camera, turned_only, field_of(config.filter)}, {}, seen[k - 1]));
  }
  return result;
}

constexpr double kRate_hz = 1;  // of the rows

/// Errors, or their squares, of attitude, and of velocity in the rover's frame.
struct DriftErrors {
  double tilt_rad = 0;                                       ///< about each horizontal axis
  double heading_rad = 0;                                    ///< about the vertical
  Eigen::Vector3d velocity_B_mps = Eigen::Vector3d::Zero();  ///< forward, lateral, vertical
};

/// The squared errors at one time.
DriftErrors squares_of(const EgoMotionEstimator& estimator, const sim::Observation& frame,
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

/// The configured scenario with another IMU. Odometry is the scenario's own, or else the default.
scenario::Scenario with_imu(const StudyConfig& config, const scenario::ImuNoise& noise,
                            bool odometry) {
  scenario::Scenario s = config.scenario;
  s.imu.noise = noise;
  if (odometry && !s.odometry.enabled) s.odometry = {.enabled = true};
  s.odometry.enabled = odometry;
  s.ego_motion = scenario::EgoMotionSource::imu;
  return s;
}

/// The results of a drive for each of so many seeds, in their order.
/// \param work called with the scenario of a seed and the drive with its noise.
template <class Work>
auto for_seeds(const scenario::Scenario& scenario, const sim::Drive& ideal, int seeds,
               const Tick& tick, const Work& work) {
  std::vector<decltype(work(scenario, ideal))> all(static_cast<std::size_t>(seeds));
  process::for_each_parallel(
      seeds,
      [&](int i) {
        scenario::Scenario s = scenario;
        s.seed += static_cast<std::uint64_t>(i);
        all[static_cast<std::size_t>(i)] = work(s, with_noise(ideal, s));
      },
      tick);
  return all;
}

const char* yes_or_no(bool flag) {
  return flag ? "yes" : "no";
}

}  // namespace

std::vector<NamedImu> imus(const StudyConfig& config) {
  const scenario::ImuNoise& own = config.scenario.imu.noise;
  std::vector<NamedImu> all;
  for (const std::string& name : scenario::imu_preset_names()) {
    all.push_back({name, *scenario::imu_preset(name)});
  }
  const auto found = std::ranges::find(all, own, &NamedImu::noise);
  if (found == all.end()) {
    all.insert(all.begin(), {"own", own});
  } else {
    std::rotate(all.begin(), found, found + 1);
  }
  return all;
}

int sensor_pieces(const StudyConfig& config) {
  const int for_imu = static_cast<int>(rates(config).size()) * config.effort.noise_seeds +
                      config.effort.drift_seeds;
  return static_cast<int>(kRoughness_m.size()) +
         2 * static_cast<int>(imus(config).size()) * for_imu;
}

void add_imu_rows(const StudyConfig& config, Table& rows, const Tick& tick) {
  const PointSet points = coarse_points(config);
  const int seeds = config.effort.noise_seeds;
  for (const double rate_hz : rates(config)) {
    const sim::Drive ideal = sim::drive(straight_drive(config, kImuDrive_s, rate_hz));
    const auto seen = landmarks_along(ideal, points, field_of(config.filter));
    for (const NamedImu& imu : imus(config)) {
      for (const bool odometry : {false, true}) {
        const scenario::Scenario scenario = with_imu(config, imu.noise, odometry);
        const auto of_seed =
            for_seeds(scenario, ideal, seeds, tick, [&](const auto& s, const sim::Drive& drive) {
              return errors_along(config, drive, s, seen);
            });
        Errors together;
        for (const Errors& e : of_seed) {
          append(together.all, e.all);
          append(together.rotation, e.rotation);
        }
        rows.add(imu.name, rate_hz, yes_or_no(odometry), static_cast<double>(seeds),
                 expected_rms_px(config, ideal, seen, scenario, rate_hz, true),
                 summary(std::move(together.rotation)).rms_px,
                 expected_rms_px(config, ideal, seen, scenario, rate_hz, false),
                 summary(std::move(together.all)));
      }
    }
  }
}

void add_bump_rows(const StudyConfig& config, Table& rows, const Tick& tick) {
  const PointSet points = coarse_points(config);
  const double rate_hz = config.scenario.camera.rate_hz;
  const double duration_s =
      std::clamp(kBumpyWay_m / config.speed_mps, 2 / rate_hz, kLongestBumps_s);
  const scenario::Scenario own =
      with_imu(config, config.scenario.imu.noise, config.scenario.odometry.enabled);
  const Intrinsics camera = bench::intrinsics(config.camera);
  // One after the other: the physics engine's error handlers belong to the whole process.
  for (const double roughness_m : kRoughness_m) {
    const sim::Drive drive = sim::drive(bumpy_drive(config, duration_s, rate_hz, roughness_m));
    const auto seen = landmarks_along(drive, points, field_of(config.filter));
    const sim::Drive told = with_noise(drive, own);
    bench::EgoMotionFeed feed(own, drive.calibration);

    std::vector<double> turns_deg;
    struct Way {
      std::string rotation, told;
      RotationModel model;
      std::vector<double> errors_px, expected_px;
    };
    std::vector<Way> ways = {{"none", "truth", RotationModel::homography, {}, {}},
                             {"as_printed", "truth", RotationModel::as_printed, {}, {}},
                             {"first_order", "truth", RotationModel::first_order, {}, {}},
                             {"homography", "truth", RotationModel::homography, {}, {}},
                             {"homography", "imu", RotationModel::homography, {}, {}}};
    for (std::size_t k = 0; k < told.frames.size(); ++k) {
      const bench::EgoMotionFeed::Motions motions = feed.next(told.frames[k]);
      if (k == 0) continue;
      turns_deg.push_back(Eigen::AngleAxisd(motions.exact.R_cur_prev).angle() / kDegree);
      EgoMotion unturned = motions.exact;
      unturned.R_cur_prev.setIdentity();
      unturned.w_C_radps.setZero();
      for (Way& way : ways) {
        const EgoMotion& motion = way.rotation == "none" ? unturned
                                  : way.told == "imu"    ? motions.told
                                                         : motions.exact;
        append(way.errors_px, errors({camera, motion, field_of(config.filter)},
                                     {way.model, DepthSource::truth}, seen[k - 1]));
        for (const Landmark& landmark : seen[k - 1]) {
          const Vec2 x = landmark.before_px - camera.centre_px;
          const Eigen::Vector3d w = motions.exact.w_C_radps * motions.exact.dt_s;
          if (way.rotation == "none") {
            way.expected_px.push_back((rotation_jacobian(x, camera.focal_px) * w).norm());
          } else if (way.rotation == "first_order") {
            way.expected_px.push_back(second_order_rotation(x, w, camera.focal_px).norm());
          }
        }
      }
    }
    for (Way& way : ways) {
      rows.add(roughness_m, scoring::median(turns_deg).value_or(0),
               scoring::quantile(turns_deg, 0.95).value_or(0),
               scoring::quantile(turns_deg, 1).value_or(0), way.rotation, way.told,
               way.expected_px.empty() ? std::nan("") : summary(std::move(way.expected_px)).rms_px,
               summary(std::move(way.errors_px)));
    }
    tick(1);
  }
}

void add_drift_rows(const StudyConfig& config, Table& rows, const Tick& tick) {
  const sim::Drive ideal = sim::drive(straight_drive(config, config.effort.drift_s, kRate_hz));
  const int seeds = config.effort.drift_seeds;
  for (const NamedImu& imu : imus(config)) {
    for (const bool odometry : {false, true}) {
      const scenario::Scenario scenario = with_imu(config, imu.noise, odometry);
      const auto of_seed =
          for_seeds(scenario, ideal, seeds, tick, [&](const auto& s, const sim::Drive& drive) {
            bench::EgoMotionFeed feed(s, drive.calibration);
            std::vector<DriftErrors> squares;
            for (const sim::Observation& frame : drive.frames) {
              feed.next(frame);
              squares.push_back(squares_of(feed.estimator(), frame, drive.calibration));
            }
            return squares;
          });
      for (std::size_t k = 0; k < ideal.frames.size(); ++k) {
        DriftErrors sum;
        for (const auto& squares : of_seed) {
          sum.tilt_rad += squares[k].tilt_rad;
          sum.heading_rad += squares[k].heading_rad;
          sum.velocity_B_mps += squares[k].velocity_B_mps;
        }
        const double t_s = static_cast<double>(k) / kRate_hz;
        const Eigen::Vector3d v_mps = (sum.velocity_B_mps / seeds).cwiseSqrt();
        const DriftErrors expected =
            expected_errors(config, scenario, ideal.calibration.gravity_mps2, t_s);
        const Eigen::Vector3d& expected_mps = expected.velocity_B_mps;
        rows.add(imu.name, yes_or_no(odometry), t_s, static_cast<double>(seeds),
                 std::sqrt(sum.tilt_rad / seeds), std::sqrt(sum.heading_rad / seeds), v_mps.x(),
                 v_mps.y(), v_mps.z(), expected.tilt_rad, expected.heading_rad, expected_mps.x(),
                 expected_mps.y(), expected_mps.z());
      }
    }
  }
}

}  // namespace lcs::kinematics
