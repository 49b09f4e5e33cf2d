#include "tools/replay/sensor_yaml.h"

#include <fmt/format.h>
#include <yaml-cpp/yaml.h>

#include <array>
#include <cmath>
#include <stdexcept>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/text_file.h"

namespace lcs::replay {
namespace {

/// Kalibr leaves out "%YAML:1.0" lines, OpenCV's FileStorage insists on them; yaml-cpp takes
/// neither the colon nor tags.
std::string without_directive(std::string text) {
  if (text.starts_with("%YAML:")) text.front() = '#';
  return text;
}

std::vector<double> numbers(const YAML::Node& node, const char* key, std::size_t least) {
  const auto values = node[key].as<std::vector<double>>();
  for (const double value : values) {
    if (!std::isfinite(value)) throw std::runtime_error(fmt::format("{} is not finite", key));
  }
  if (values.size() < least) {
    throw std::runtime_error(fmt::format("{} has {} numbers, not {}", key, values.size(), least));
  }
  return values;
}

sim::Pose read_pose(const YAML::Node& node) {
  // EuRoC has {cols, rows, data}, Kalibr's own files a list of rows.
  std::vector<double> flat;
  if (node.IsMap()) {
    flat = node["data"].as<std::vector<double>>();
  } else {
    for (const auto& row : node.as<std::vector<std::vector<double>>>()) {
      flat.insert(flat.end(), row.begin(), row.end());
    }
  }
  std::array<double, 16> matrix;
  if (flat.size() != matrix.size()) {
    throw std::runtime_error(fmt::format("T_BS has {} numbers, not 16", flat.size()));
  }
  std::copy(flat.begin(), flat.end(), matrix.begin());
  try {
    return sequence::pose_of(matrix);
  } catch (const std::invalid_argument& error) {
    throw std::runtime_error(fmt::format("T_BS {}", error.what()));
  }
}

Lens read_lens(const YAML::Node& yaml) {
  Lens lens;
  const std::vector<double> intrinsics = numbers(yaml, "intrinsics", 4);
  lens.fu_px = intrinsics[0];
  lens.fv_px = intrinsics[1];
  lens.cu_px = intrinsics[2];
  lens.cv_px = intrinsics[3];
  if (!(lens.fu_px > 0 && lens.fv_px > 0)) {
    throw std::runtime_error("the focal lengths in intrinsics must be above 0");
  }
  const auto model = yaml["distortion_model"].as<std::string>("none");
  if (model == "none") return lens;
  if (model == "radial-tangential" || model == "radtan") {
    lens.distortion = Lens::Distortion::radial_tangential;
  } else if (model == "equidistant") {
    lens.distortion = Lens::Distortion::equidistant;
  } else {
    throw std::runtime_error(fmt::format(
        "distortion_model is '{}'; known are radial-tangential, equidistant and none", model));
  }
  lens.coefficients = numbers(yaml, "distortion_coefficients", 4);
  return lens;
}

scenario::ImuNoise read_noise(const YAML::Node& yaml) {
  const auto value = [&](const char* key) {
    const auto number = yaml[key].as<double>();
    if (std::isfinite(number) && number >= 0) return number;
    throw std::runtime_error(fmt::format("{} is {}; it must not be negative", key, number));
  };
  return {.gyroscope_noise_density = value("gyroscope_noise_density"),
          .gyroscope_random_walk = value("gyroscope_random_walk"),
          .accelerometer_noise_density = value("accelerometer_noise_density"),
          .accelerometer_random_walk = value("accelerometer_random_walk")};
}

}  // namespace

SensorYaml read_sensor_yaml(const std::filesystem::path& file) {
  const std::string text = without_directive(sequence::read_file(file));
  SensorYaml sensor;
  try {
    const YAML::Node yaml = YAML::Load(text);
    if (yaml["T_BS"]) sensor.T_BS = read_pose(yaml["T_BS"]);
    if (yaml["rate_hz"]) sensor.rate_hz = yaml["rate_hz"].as<double>();
    if (yaml["intrinsics"]) sensor.lens = read_lens(yaml);
    if (yaml["gyroscope_noise_density"]) sensor.noise = read_noise(yaml);
  } catch (const YAML::Exception& error) {
    throw std::runtime_error(
        fmt::format("{}:{}: {}", file.string(), error.mark.line + 1, error.msg));
  } catch (const std::runtime_error& error) {
    throw std::runtime_error(fmt::format("{}: {}", file.string(), error.what()));
  }
  return sensor;
}

}  // namespace lcs::replay
