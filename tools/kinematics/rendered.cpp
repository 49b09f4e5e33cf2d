#include "tools/kinematics/study.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

#include "filter/detect/fast.h"
#include "sim/simulation.h"
#include "tools/bench/detector.h"
#include "tools/bench/ego_motion_feed.h"

namespace lcs::kinematics {
namespace {

constexpr int kStillFrames = 5;
constexpr double kBumps_m = 2.5e-3;  // if the scenario's ground has none

std::vector<Eigen::Vector2f> corners_of(const FastDetector& detector, const cv::Mat3b& image) {
  cv::Mat1b grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return detector.detect(grey);
}

/// The filter's landmarks on fixed objects, with their true positions in the next frame.
std::vector<Landmark> landmarks_of(const Layers& layers, const sim::Pinhole& camera,
                                   const sim::FrameTruth& truth, double min_depth_m) {
  std::vector<Eigen::Vector2f> places;
  std::vector<double> ratios;
  for (const Edge& edge : layers.normal_edges) {
    if (edge.corner < 0) continue;
    places.push_back(edge.location.cast<float>());
    ratios.push_back(edge.depth_ratio);
  }
  const sim::Pose T_NC = truth.next.T_WC.inverse() * truth.now.T_WC;
  std::vector<Landmark> landmarks;
  const auto labels = sim::label_corners(camera, truth, places, min_depth_m);
  for (std::size_t i = 0; i < places.size(); ++i) {
    if (labels[i].label != sim::Label::fixed || !labels[i].static_motion_px.allFinite()) continue;
    const Vec2 before = places[i].cast<double>();
    const Vec2 after = before + labels[i].static_motion_px;
    if (after.minCoeff() < 0 || after.x() > camera.width_px - 1 || after.y() > camera.height_px - 1)
      continue;
    landmarks.push_back(
        {.before_px = before,
         .after_px = after,
         .depth_after_m = (T_NC * camera.back_project(before, labels[i].depth_m)).z(),
         .learnt_ratio = ratios[i]});
  }
  return landmarks;
}

scenario::Scenario with_sensors(scenario::Scenario scenario, const StudyConfig& config) {
  scenario.imu = config.scenario.imu;
  scenario.odometry = config.scenario.odometry;
  scenario.image = config.scenario.image;
  return scenario;
}

}  // namespace

DriveResult rendered_drive(const StudyConfig& config, const NamedDrive& drive, Table& rows,
                           const Tick& tick) {
  const scenario::Scenario& scenario = drive.scenario;
  sim::Simulation simulation(scenario);
  const sim::Pinhole camera = simulation.calibration().camera;
  const Intrinsics intrinsics = bench::intrinsics(camera);
  const FastDetector detector(scenario.fast_threshold);
  bench::EgoMotionFeed feed(scenario, simulation.calibration());
  AnyFilter filter(intrinsics, config.filter);

  struct Case {
    std::string told;
    FieldModel model;
    std::vector<double> errors_px;
  };
  std::vector<Case> cases;
  for (const char* told : {"truth", "imu"}) {
    for (const FieldModel& model : kModels) cases.push_back({told, model, {}});
  }
  DriveResult result;
  std::vector<double> reference_px;  // by theory, for the reference depth
  std::vector<Landmark> landmarks;   // of the previous frame
  const int every = std::max(1, scenario.frames / kStillFrames);
  while (const auto frame = simulation.next()) {
    const bench::EgoMotionFeed::Motions motions = feed.next(*frame);
    result.turn_max_rad =
        std::max(result.turn_max_rad, Eigen::AngleAxisd(motions.exact.R_cur_prev).angle());
    for (Case& each : cases) {
      const EgoMotion& motion = each.told == "truth" ? motions.exact : motions.told;
      append(each.errors_px,
             errors({intrinsics, motion, field_of(config.filter)}, each.model, landmarks));
    }
    const MotionField exact(intrinsics, motions.exact, field_of(config.filter));
    for (const Landmark& landmark : landmarks) {
      const double ratio = exact.reference_depth_m() / landmark.depth_after_m;
      reference_px.push_back(exact.reference_speed(exact.rotated(landmark.before_px)) *
                             exact.dt_s() * std::abs(ratio - 1));
    }
    const auto corners = corners_of(detector, frame->image);
    const FrameResult& seen = filter.step(corners, motions.told);
    landmarks = landmarks_of(seen.layers, camera, frame->truth, scenario.truth_min_depth_m);
    if (frame->index % every == 0) {
      result.still_frames.push_back(rendered_points(camera, frame->truth, corners));
    }
    tick(1);
  }
  for (Case& each : cases) {
    const bool is_expected = each.told == "truth" &&
                             each.model.rotation == RotationModel::homography &&
                             each.model.depth == DepthSource::reference;
    rows.add(drive.name, each.told, each.model,
             is_expected ? summary(reference_px).median_px : std::nan(""),
             summary(std::move(each.errors_px)));
  }
  return result;
}

std::vector<NamedDrive> drives(const StudyConfig& config) {
  const double rate_hz = config.scenario.camera.rate_hz;
  const int frames = config.effort.drive_frames;
  const double duration_s = (frames - 1) / rate_hz;
  scenario::Scenario configured = config.scenario;
  configured.frames = std::min(configured.frames, frames);
  const double bumps_m = config.scenario.ground ? config.scenario.ground->roughness_m : kBumps_m;
  return {{"configured", configured},
          {"straight", with_sensors(straight_drive(config, duration_s, rate_hz), config)},
          {"turning",
           with_sensors(curved_drive(config, duration_s, rate_hz, kTurning_deg * kDegree * rate_hz),
                        config)},
          {"bumps", with_sensors(bumpy_drive(config, duration_s, rate_hz, bumps_m), config)}};
}

PointSet rendered_with_lens(const StudyConfig& config, double fovy_rad) {
  scenario::Scenario scenario = config.scenario;
  scenario.camera.fovy_rad = fovy_rad;
  scenario.frames = 1;
  sim::Simulation simulation(scenario);
  const auto frame = simulation.next();
  return rendered_points(simulation.calibration().camera, frame->truth,
                         corners_of(FastDetector(scenario.fast_threshold), frame->image));
}

}  // namespace lcs::kinematics
