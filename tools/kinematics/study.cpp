#include "tools/kinematics/study.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>

#include "sim/imu/imu_noise.h"
#include "tools/bench/detector.h"
#include "tools/files/csv.h"
#include "tools/kinematics/theory.h"

namespace lcs::kinematics {
namespace {

/// Velocity and body rate of the camera, in C.
struct Motion {
  Eigen::Vector3d v_mps, w_radps;
};

Motion motion_of(const sim::Observation& frame) {
  return {frame.truth.now.T_WC.R.transpose() * frame.truth.v_WC_mps, frame.truth.w_C_radps};
}

sim::Pose T_CN_after(const Motion& motion, double dt_s) {
  const double turn_rad = motion.w_radps.norm() * dt_s;
  sim::Pose T_CN;
  T_CN.p = motion.v_mps * dt_s;
  if (turn_rad != 0) {
    T_CN.R = Eigen::AngleAxisd(turn_rad, motion.w_radps.normalized()).toRotationMatrix();
  }
  return T_CN;
}

/// The way of each point by a motion during `dt_s`, exact and by the motion field.
void add_ways(const PointSet& points, const Motion& motion, double dt_s, std::vector<double>& exact,
              std::vector<double>& field) {
  const std::vector<Vec2> after = points.seen_from(T_CN_after(motion, dt_s));
  for (std::size_t i = 0; i < after.size(); ++i) {
    if (!after[i].allFinite()) continue;
    const Site& site = points.sites[i];
    const double focal_px = points.camera.focal_px;
    const Vec2 x_px = site.px - points.camera.centre_px;
    exact.push_back((after[i] - site.px).norm());
    field.push_back((velocity_jacobian(x_px, focal_px, site.depth_m, dt_s) * motion.v_mps +
                     rotation_jacobian(x_px, focal_px) * motion.w_radps * dt_s)
                        .norm());
  }
}

/// A distorted picture's points, taken for points of the pinhole's picture.
void add_distorted(const PointSet& points, const sim::Optics& optics, const sim::Pose& T_CN,
                   std::vector<double>& errors) {
  const sim::Pose T_NC = T_CN.inverse();
  for (const Site& site : points.sites) {
    const Eigen::Vector3d p_C = optics.back_project(site.px, site.depth_m);
    if (!p_C.allFinite()) continue;
    const Eigen::Vector3d p_N = T_NC * p_C;
    const Eigen::Vector3d wrong_N = T_NC * points.camera.back_project(site.px, site.depth_m);
    if (p_N.z() <= 0 || wrong_N.z() <= 0) continue;
    const Vec2 after = optics.project(p_N);
    if (after.allFinite()) errors.push_back((points.camera.project(wrong_N) - after).norm());
  }
}

constexpr const char* kPointsSeen = "points_seen";  // the first column of a summary, the last ones

std::string text_of(const Cell& cell) {
  const auto* const figure = std::get_if<double>(&cell);
  if (figure == nullptr) return std::get<std::string>(cell);
  return std::isfinite(*figure) ? fmt::format("{:.6g}", *figure) : "";
}

}  // namespace

constexpr std::array kStudyDepths_m = {1.0, 2.0, 4.0, 8.0, 16.0};
constexpr std::array kLenses_deg = {20.0, 30.0, 45.0, 60.0, 75.0, 90.0, 110.0};
constexpr int kSweeps = 3;

PointSet study_points(const sim::Pinhole& camera) {
  return geometric_points(camera, kStudyDepths_m);
}

int study_pieces(const StudyConfig& config) {
  int frames = 0;
  for (const NamedDrive& drive : drives(config)) frames += drive.scenario.frames;
  return frames + kSweeps + static_cast<int>(kLenses_deg.size()) + sensor_pieces(config);
}

Study carry_out(const StudyConfig& config, const Tick& tick) {
  Study study;
  study.config = config;

  std::vector<PointSet> rendered;
  for (const NamedDrive& drive : drives(config)) {
    DriveResult result = rendered_drive(config, drive, study.drives, tick);
    if (!rendered.empty()) continue;  // the first drive is the configured one
    study.turn_max_rad = result.turn_max_rad;
    rendered = std::move(result.still_frames);
  }

  const std::vector<PointSet> geometric = {study_points(config.camera)};
  for (const auto* points : {&geometric, &std::as_const(rendered)}) {
    sweep_rotation(config, *points, study.rotation);
    sweep_foe_distance(config, *points, study.foe);
    sweep_mount(config, *points, study.mount);
    tick(1);
  }
  sweep_translation(config, rendered, study.translation);
  tick(1);
  for (const double fovy_deg : kLenses_deg) {
    const double fovy_rad = fovy_deg * kDegree;
    const sim::Pinhole camera =
        sim::Pinhole::from_fovy(config.camera.width_px, config.camera.height_px, fovy_rad);
    add_focal_length(config, study_points(camera), fovy_deg, study.focal);
    add_focal_length(config, rendered_with_lens(config, fovy_rad), fovy_deg, study.focal);
    tick(1);
  }
  add_bump_rows(config, study.bumps, tick);
  add_imu_rows(config, study.imu, tick);
  add_drift_rows(config, study.drift, tick);
  study.left_out = left_out(config);
  return study;
}

constexpr double kStandInSpeed_mps = 0.5;  // if the scenario's rover is static

StudyConfig configure(const scenario::Scenario& scenario, const Effort& effort) {
  StudyConfig config;
  config.scenario = scenario;
  config.lens = sim::lens_of(scenario.camera);
  // the filter gets corners without distortion
  scenario::Camera& camera = config.scenario.camera;
  if (camera.focal_px || camera.distortion) {
    camera.fovy_rad = 2 * std::atan(camera.height_px / 2.0 / config.lens.pinhole().focal_px);
    camera.focal_px.reset();
    camera.distortion.reset();
  }
  config.filter = bench::filter_parameters(scenario);
  config.effort = effort;
  for (const scenario::EgoPhase& phase : scenario.ego.phases) {
    config.speed_mps = std::max(config.speed_mps, phase.speed_mps);
  }
  const std::vector<scenario::Waypoint>& points = scenario.ego.waypoints;
  for (std::size_t i = 1; i < points.size(); ++i) {
    config.speed_mps =
        std::max(config.speed_mps, (points[i].position_m - points[i - 1].position_m).norm() /
                                       (points[i].at_s - points[i - 1].at_s));
  }
  config.stands = config.speed_mps <= field_of(config.filter).still_speed_mps;
  if (config.stands) config.speed_mps = kStandInSpeed_mps;
  const sim::Calibration calibration = sim::drive(straight_drive(config, 0, 1)).calibration;
  config.camera = calibration.camera;
  config.forward_C = calibration.T_BC.R.transpose() * Eigen::Vector3d::UnitX();
  return config;
}

scenario::Scenario straight_drive(const StudyConfig& config, double duration_s, double rate_hz) {
  scenario::Scenario s = config.scenario;
  s.frames = static_cast<int>(std::floor(duration_s * rate_hz + 1e-9)) + 1;
  s.ego.drive = scenario::Drive::holonomic;
  s.ego.phases = {{.speed_mps = config.speed_mps}};
  s.ego.waypoints.clear();
  s.ego.path.clear();
  s.camera.rate_hz = rate_hz;
  s.camera.rolling_shutter_s = s.camera.exposure_s = s.camera.told.time_offset_error_s = 0;
  s.imu.noise = {};
  s.imu.gyroscopes = {};
  s.imu.accelerometers = {};
  s.imu.gaps.clear();
  s.odometry.enabled = true;
  s.odometry.noise_mps = s.odometry.yaw_noise_radps = s.odometry.scale_error = 0;
  s.ego_motion = scenario::EgoMotionSource::imu;
  s.image = {};
  s.image.noise.reset();
  s.ground.reset();
  s.actors.clear();
  return s;
}

scenario::Scenario curved_drive(const StudyConfig& config, double duration_s, double rate_hz,
                                double yaw_rate_radps) {
  scenario::Scenario s = straight_drive(config, duration_s, rate_hz);
  s.ego.phases[0].yaw_rate_radps = yaw_rate_radps;
  return s;
}

scenario::Scenario bumpy_drive(const StudyConfig& config, double duration_s, double rate_hz,
                               double roughness_m) {
  scenario::Scenario s = straight_drive(config, duration_s, rate_hz);
  s.ego.drive = scenario::Drive::wheeled;
  s.ground = config.scenario.ground.value_or(scenario::RoughGround{});
  s.ground->roughness_m = roughness_m;
  if (roughness_m == 0) s.ground.reset();
  return s;
}

sim::Drive with_noise(const sim::Drive& ideal, const scenario::Scenario& noisy) {
  sim::Drive drive = ideal;
  sim::ImuNoiseModel imu(noisy.imu, noisy.seed);
  sim::OdometryNoiseModel odometry(noisy.odometry, noisy.seed);
  for (sim::Observation& frame : drive.frames) {
    for (sim::ImuSample& sample : frame.imu) sample = imu.corrupt(sample);
    if (!noisy.odometry.enabled) frame.odometry.clear();
    for (sim::OdometrySample& sample : frame.odometry) sample = odometry.corrupt(sample);
  }
  return drive;
}

LeftOut left_out(const StudyConfig& config) {
  scenario::Scenario scenario = config.scenario;
  LeftOut result;
  scenario::Camera& camera = scenario.camera;
  result.readout_s = camera.rolling_shutter_s > 0 ? camera.rolling_shutter_s : kReadout_s;
  result.offset_s =
      camera.told.time_offset_error_s != 0 ? camera.told.time_offset_error_s : kOffset_s;
  camera.rolling_shutter_s = camera.exposure_s = camera.told.time_offset_error_s = 0;
  scenario.frames = std::min(scenario.frames, config.effort.drive_frames);
  const sim::Optics optics(config.lens);
  const PointSet points = study_points(config.camera);
  std::vector<double> distortion, readout, readout_field, offset, offset_field;
  const std::vector<sim::Observation> frames = sim::drive(scenario).frames;
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Motion now = motion_of(frames[k]);
    add_ways(points, now, result.readout_s, readout, readout_field);
    if (!optics.is_pinhole()) {
      add_distorted(points, optics, T_CN_after(now, config.frame_s()), distortion);
    }
    if (k == 0) continue;
    const Motion before = motion_of(frames[k - 1]);
    add_ways(points, {now.v_mps - before.v_mps, now.w_radps - before.w_radps}, result.offset_s,
             offset, offset_field);
  }
  result.distortion_px = summary(distortion).p95_px;
  result.readout_px = summary(readout).p95_px;
  result.offset_px = summary(offset).p95_px;
  result.expected_readout_px = summary(readout_field).p95_px;
  result.expected_offset_px = summary(offset_field).p95_px;
  return result;
}

Table::Table(const std::string& columns) {
  for (const std::string_view column : files::fields_of(columns)) columns_.emplace_back(column);
}

std::size_t Table::place_of(const char* column) const {
  const auto found = std::ranges::find(columns_, column);
  if (found == columns_.end()) throw std::logic_error("an experiment lacks a column of the answer");
  return static_cast<std::size_t>(found - columns_.begin());
}

std::vector<double> Table::figures(const char* column, const Where& where) const {
  std::vector<double> all;
  for (const std::vector<Cell>& row : rows_) {
    const auto fits = [&](const auto& each) { return row[place_of(each.first)] == each.second; };
    if (std::ranges::all_of(where, fits)) all.push_back(std::get<double>(row[place_of(column)]));
  }
  return all;
}

double Table::figure(const char* column, const Where& where) const {
  const std::vector<double> all = figures(column, where);
  if (all.empty()) throw std::logic_error("an experiment lacks a row of the answer");
  return all.front();
}

std::string Table::csv() const {
  std::string text = fmt::format("{}\n", fmt::join(columns_, ","));
  for (const std::vector<Cell>& row : rows_) {
    bool is_seen = true;
    for (std::size_t i = 0; i < row.size(); ++i) {
      text += fmt::format("{}{}", i > 0 ? "," : "", is_seen ? text_of(row[i]) : "");
      if (columns_[i] == kPointsSeen) is_seen = row[i] != Cell(0.0);
    }
    text += '\n';
  }
  return text;
}

void Table::put(const FieldModel& model) {
  put(name(model.rotation));
  put(name(model.depth));
}

void Table::put(const double (&three)[3]) {
  for (const double figure : three) put(figure);
}

void Table::put(const ErrorSummary& e) {
  for (const double figure :
       {static_cast<double>(e.count), e.median_px, e.p95_px, e.max_px, e.rms_px}) {
    put(figure);
  }
}

}  // namespace lcs::kinematics
