#include "tools/sequence/replay_settings.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <span>
#include <stdexcept>

#include "tools/files/json_node.h"
#include "tools/sequence/pose_text.h"

namespace lcs::sequence {
namespace {

using Node = files::JsonNode;

constexpr const char* kImu = "imu";
constexpr const char* kTruth = "truth";
constexpr const char* kFromPicture = "auto";
constexpr const char* kEquidistant = "equidistant";

/// Larger values leave dead reckoning without precise digits.
constexpr double kMost = 1e6;

void require_moderate(const Node& node, std::span<const double> numbers) {
  for (const double number : numbers) node.require(std::abs(number) <= kMost, "within a million");
}

Eigen::Vector3d vector_in(const Node& node) {
  const auto numbers = node.numbers<3>();
  require_moderate(node, numbers);
  return {numbers[0], numbers[1], numbers[2]};
}

int pixels_in(const Node& node) {
  const int pixels = node.natural<int>();
  node.require(pixels > 0, "above 0");
  return pixels;
}

double not_negative_in(const Node& node) {
  const double number = node.number();
  node.require(number >= 0 && number <= kMost, "0 or more and at most a million");
  return number;
}

sim::Pose pose_in(const Node& node) {
  const auto matrix = node.numbers<16>();
  require_moderate(node, matrix);
  try {
    return pose_of(matrix);
  } catch (const std::invalid_argument&) {
    node.require(false, "a rigid transform");
    throw;
  }
}

sim::Lens lens_in(const Node& camera, const std::string& file) {
  const auto centre = camera["centre_px"].numbers<2>();
  sim::Lens lens;
  const Node focal = camera["focal_px"];
  const auto focal_px =
      focal.is_list() ? focal.numbers<2>() : std::array{focal.number(), focal.number()};
  focal.require(std::ranges::all_of(focal_px, [](double f) { return f > 0 && f <= kMost; }),
                "above 0 and at most a million");
  lens = {.fu_px = focal_px[0],
          .fv_px = focal_px[1],
          .cu_px = centre[0],
          .cv_px = centre[1],
          .coefficients = {},
          .width_px = pixels_in(camera["width_px"]),
          .height_px = pixels_in(camera["height_px"]),
          .source = {file, 0}};
  if (camera.has("distortion")) {
    const Node distortion = camera["distortion"];
    scenario::Distortion read{.equidistant = !distortion.is_list(), .coefficients = {}};
    const Node coefficients = read.equidistant ? distortion[kEquidistant] : distortion;
    coefficients.each([&](const Node& number) { read.coefficients.push_back(number.number()); });
    coefficients.require(read.coefficients.size() == (read.equidistant ? 4 : 5),
                         read.equidistant ? "a list of 4 numbers" : "a list of 5 numbers");
    require_moderate(coefficients, read.coefficients);
    sim::set_distortion(read, lens);
  }
  return lens;
}

void read_calibration(const Node& node, const std::string& file, ReplaySettings& settings) {
  sim::Calibration& calibration = settings.calibration;
  settings.lens = lens_in(node["camera"], file);
  if (node.has("cameras")) {
    node["cameras"].each([&](const Node& one) {
      settings.cameras.push_back(
          {one["name"].text(), lens_in(one["camera"], file), pose_in(one["T_BC"])});
    });
    settings.filter_place = node["filter_place"].natural<std::size_t>();
    node["filter_place"].require(settings.filter_place < settings.cameras.size(),
                                 "the place of one of the cameras");
  }
  calibration.T_BC = pose_in(node["T_BC"]);
  calibration.T_BS = pose_in(node["T_BS"]);
  calibration.T_WB_start = pose_in(node["T_WB_start"]);
  calibration.v_WB_start_mps = vector_in(node["v_WB_start_mps"]);
  if (node.has("time_offset_s")) {
    const Node offset = node["time_offset_s"];
    calibration.time_offset_s = offset.number();
    offset.require(std::abs(calibration.time_offset_s) <= kMost, "within a million");
  }
  calibration.gravity_mps2 = not_negative_in(node["gravity_mps2"]);
  calibration.on_ground = node["on_ground"].flag();
}

void read_scenario(const Node& node, const std::string& file, scenario::Scenario& scenario) {
  scenario.name = node["scenario"].text();
  scenario.seed = node["seed"].natural();
  if (node.has("origin")) {
    scenario::Origin& origin = scenario.origin.emplace();
    origin.family = node["origin"]["family"].text();
    origin.seed = node["origin"]["seed"].natural();
  }
  const Node rate = node["camera_rate_hz"];
  scenario.camera.rate_hz = rate.number();
  rate.require(scenario.camera.rate_hz > 0 && scenario.camera.rate_hz <= kMost,
               "above 0 and at most a million");
  const std::string source = node["ego_motion"].text();
  node["ego_motion"].require(source == kImu || source == kTruth, "imu or truth");
  scenario.ego_motion =
      source == kTruth ? scenario::EgoMotionSource::truth : scenario::EgoMotionSource::imu;
  for (const auto& [key, member] : kImuNoise) {
    scenario.imu.noise.*member = not_negative_in(node["imu_noise"][key]);
  }
  scenario.odometry.enabled = node["odometry"].flag();
  scenario.odometry.noise_mps = not_negative_in(node["odometry_noise_mps"]);
  if (node.has("odometry_yaw_noise_radps")) {  // older sequences lack the yaw rate
    scenario.odometry.yaw_noise_radps = not_negative_in(node["odometry_yaw_noise_radps"]);
  }
  const Node threshold = node["fast_threshold"];
  scenario.fast_threshold.reset();  // the detector checks the range of a number
  if (!threshold.is_text(kFromPicture)) scenario.fast_threshold = threshold.natural<int>();
  scenario.filter_preset = node["filter_preset"].text();
  scenario.filter_preset_source = {file, 0};
  node["filter"].each_entry([&](const std::string& key, const Node& value) {
    scenario.filter.push_back({key, value.text(), {file, 0}});
  });
}

files::Json lens_json(const sim::Lens& lens) {
  files::Json camera = {
      {"focal_px",
       lens.fu_px == lens.fv_px ? files::Json(lens.fu_px) : files::Json{lens.fu_px, lens.fv_px}},
      {"centre_px", {lens.cu_px, lens.cv_px}},
      {"width_px", lens.width_px},
      {"height_px", lens.height_px}};
  if (!lens.coefficients.empty()) {
    const bool is_fisheye = lens.distortion == sim::Lens::Distortion::equidistant;
    camera["distortion"] = is_fisheye ? files::Json{{kEquidistant, lens.coefficients}}
                                      : files::Json(lens.coefficients);
  }
  return camera;
}

}  // namespace

std::string settings_text(const SequenceInfo& info) {
  const scenario::Scenario& scenario = info.scenario;
  const sim::Calibration& calibration = info.calibration;
  const Eigen::Vector3d& v = calibration.v_WB_start_mps;
  files::Json noise;
  for (const auto& [key, member] : kImuNoise) noise[key] = scenario.imu.noise.*member;
  files::Json filter = files::Json::object();
  for (const scenario::FilterSetting& setting : scenario.filter) {
    filter[setting.key] = setting.value;  // the last setting of a key holds
  }
  files::Json json = {
      {"scenario", scenario.name},
      {"seed", scenario.seed},
      {"start_ns", kEpoch_ns},
      {"camera_rate_hz", scenario.camera.rate_hz},
      {"camera", lens_json(calibration.optics.lens())},
      {"T_BC", matrix_of(calibration.T_BC)},
      {"T_BS", matrix_of(calibration.T_BS)},
      {"T_WB_start", matrix_of(calibration.T_WB_start)},
      {"v_WB_start_mps", {v.x(), v.y(), v.z()}},
      {"gravity_mps2", calibration.gravity_mps2},
      {"on_ground", calibration.on_ground},
      {"ego_motion", scenario.ego_motion == scenario::EgoMotionSource::truth ? kTruth : kImu},
      {"imu_noise", noise},
      {"odometry", scenario.odometry.enabled},
      {"odometry_noise_mps", scenario.odometry.noise_mps},
      {"odometry_yaw_noise_radps", scenario.odometry.yaw_noise_radps},
      {"fast_threshold",
       scenario.fast_threshold ? files::Json(*scenario.fast_threshold) : files::Json(kFromPicture)},
      {"filter_preset", scenario.filter_preset},
      {"filter", filter},
  };
  if (calibration.time_offset_s != 0) json["time_offset_s"] = calibration.time_offset_s;
  if (info.origin) {
    json["origin"] = {{"family", info.origin->family}, {"seed", info.origin->seed}};
  }
  for (std::size_t i = 0; i < scenario.cameras.size(); ++i) {
    json["cameras"].push_back({{"name", scenario.cameras[i].name},
                               {"camera", lens_json(info.rig[i]->optics.lens())},
                               {"T_BC", matrix_of(info.rig[i]->T_BC)}});
    json["filter_place"] = info.place;
  }
  return files::json_text(json, 2) + "\n";
}

ReplaySettings read_settings(const std::filesystem::path& file) {
  constexpr input::FileKind kSettingsDocument{
      input::kMebibyte,
      "correct it, or take it away to replay the sequence by its other files alone"};
  return files::read_json(file, kSettingsDocument, [&](const Node& node) {
    ReplaySettings settings;
    read_scenario(node, file.string(), settings.scenario);
    read_calibration(node, file.string(), settings);
    settings.start_ns = node["start_ns"].whole();
    const auto most_ns = std::numeric_limits<std::int64_t>::max() / 2;  // differences fit
    const bool is_time = settings.start_ns >= -most_ns && settings.start_ns <= most_ns;
    node["start_ns"].require(is_time, "a time");
    return settings;
  });
}

}  // namespace lcs::sequence
