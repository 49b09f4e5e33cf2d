#include "tools/sequence/replay_settings.h"

#include <fmt/format.h>

#include <nlohmann/json.hpp>
#include <stdexcept>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/text_file.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

// Keys in the order in which people read them.
using Json = nlohmann::ordered_json;

constexpr std::pair<const char*, double scenario::ImuNoise::*> kNoise[] = {
    {"gyroscope_noise_density", &scenario::ImuNoise::gyroscope_noise_density},
    {"gyroscope_random_walk", &scenario::ImuNoise::gyroscope_random_walk},
    {"accelerometer_noise_density", &scenario::ImuNoise::accelerometer_noise_density},
    {"accelerometer_random_walk", &scenario::ImuNoise::accelerometer_random_walk},
    {"gyroscope_turn_on_bias_radps", &scenario::ImuNoise::gyroscope_turn_on_bias_radps},
    {"accelerometer_turn_on_bias_mps2", &scenario::ImuNoise::accelerometer_turn_on_bias_mps2}};

constexpr const char* kImu = "imu";
constexpr const char* kTruth = "truth";

Json vector_json(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}
Eigen::Vector3d vector_in(const Json& json) {
  const auto numbers = json.get<std::array<double, 3>>();
  return {numbers[0], numbers[1], numbers[2]};
}

void read_calibration(const Json& json, sim::Calibration& calibration) {
  const Json& camera = json.at("camera");
  const auto centre = camera.at("centre_px").get<std::array<double, 2>>();
  calibration.camera.focal_px = camera.at("focal_px").get<double>();
  calibration.camera.centre_px = {centre[0], centre[1]};
  calibration.camera.width_px = camera.at("width_px").get<int>();
  calibration.camera.height_px = camera.at("height_px").get<int>();
  const auto pose = [&](const char* key) {
    return pose_of(json.at(key).get<std::array<double, 16>>());
  };
  calibration.T_BC = pose("T_BC");
  calibration.T_BS = pose("T_BS");
  calibration.T_WB_start = pose("T_WB_start");
  calibration.v_WB_start_mps = vector_in(json.at("v_WB_start_mps"));
  calibration.gravity_mps2 = json.at("gravity_mps2").get<double>();
  calibration.on_ground = json.at("on_ground").get<bool>();
}

void read_scenario(const Json& json, const std::string& file, scenario::Scenario& scenario) {
  scenario.name = json.at("scenario").get<std::string>();
  scenario.seed = json.at("seed").get<std::uint64_t>();
  scenario.camera.rate_hz = json.at("camera_rate_hz").get<double>();
  const auto source = json.at("ego_motion").get<std::string>();
  if (source != kImu && source != kTruth) {
    throw std::runtime_error(fmt::format("ego_motion is '{}', not imu or truth", source));
  }
  scenario.ego_motion =
      source == kTruth ? scenario::EgoMotionSource::truth : scenario::EgoMotionSource::imu;
  for (const auto& [key, member] : kNoise) {
    scenario.imu.noise.*member = json.at("imu_noise").at(key).get<double>();
  }
  scenario.odometry.enabled = json.at("odometry").get<bool>();
  scenario.odometry.noise_mps = json.at("odometry_noise_mps").get<double>();
  scenario.fast_threshold = json.at("fast_threshold").get<int>();
  scenario.filter_preset = json.at("filter_preset").get<std::string>();
  scenario.filter_preset_source = {file, 0};
  for (const auto& [key, value] : json.at("filter").items()) {
    scenario.filter.push_back({key, value.get<std::string>(), {file, 0}});
  }
}

}  // namespace

std::string settings_text(const scenario::Scenario& scenario, const sim::Calibration& calibration) {
  const sim::Pinhole& camera = calibration.camera;
  Json noise;
  for (const auto& [key, member] : kNoise) noise[key] = scenario.imu.noise.*member;
  Json filter = Json::object();
  for (const scenario::FilterSetting& setting : scenario.filter) {
    filter[setting.key] = setting.value;  // of a key that is set twice the last one holds
  }
  const Json json = {
      {"scenario", scenario.name},
      {"seed", scenario.seed},
      {"start_ns", kEpoch_ns},
      {"camera_rate_hz", scenario.camera.rate_hz},
      {"camera",
       {{"focal_px", camera.focal_px},
        {"centre_px", {camera.centre_px.x(), camera.centre_px.y()}},
        {"width_px", camera.width_px},
        {"height_px", camera.height_px}}},
      {"T_BC", matrix_of(calibration.T_BC)},
      {"T_BS", matrix_of(calibration.T_BS)},
      {"T_WB_start", matrix_of(calibration.T_WB_start)},
      {"v_WB_start_mps", vector_json(calibration.v_WB_start_mps)},
      {"gravity_mps2", calibration.gravity_mps2},
      {"on_ground", calibration.on_ground},
      {"ego_motion", scenario.ego_motion == scenario::EgoMotionSource::truth ? kTruth : kImu},
      {"imu_noise", noise},
      {"odometry", scenario.odometry.enabled},
      {"odometry_noise_mps", scenario.odometry.noise_mps},
      {"fast_threshold", scenario.fast_threshold},
      {"filter_preset", scenario.filter_preset},
      {"filter", filter},
  };
  return json.dump(2) + "\n";
}

ReplaySettings read_settings(const std::filesystem::path& file) {
  ReplaySettings settings;
  try {
    const Json json = Json::parse(read_file(file));
    read_scenario(json, file.string(), settings.scenario);
    read_calibration(json, settings.calibration);
    settings.start_ns = json.at("start_ns").get<std::int64_t>();
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format(
        "{}: {}; correct it, or take it away to replay the sequence by its other files alone",
        file.string(), error.what()));
  }
  return settings;
}

}  // namespace lcs::sequence
