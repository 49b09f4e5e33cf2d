#include "tools/replay/sensor_yaml.h"

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string>

#include "tools/input/input_file.h"
#include "tools/input/reader.h"
#include "tools/sequence/pose_text.h"

namespace lcs::replay {
namespace {

using input::Dimension;
using input::Error;
using input::Quantity;
using input::Reader;
using input::Value;

constexpr input::FileKind kSensorFile{input::kMebibyte, "give a sensor.yaml with Kalibr's keys"};

// Generous limits, which exclude impossible cameras and IMUs only.
constexpr Quantity kOfTransform{Dimension::number, {-10000, 10000}};
constexpr Quantity kRate{Dimension::frequency, {0, 100000, true}};
constexpr Quantity kFocal_px{Dimension::number, {1, 1000000}};
constexpr Quantity kCentre_px{Dimension::number, {-100000, 100000}};
constexpr Quantity kCoefficient{Dimension::number, {-1000, 1000}};
constexpr Quantity kNoise{Dimension::number, {0, 1000}};
constexpr int kMostPixels = 65536;

/// Comments out "%YAML:1.0": OpenCV's FileStorage requires it, YAML does not allow its colon.
std::string without_directive(std::string text) {
  if (text.starts_with("%YAML:")) text.front() = '#';
  return text;
}

void append_numbers(const Value& list, const std::string& path, const Quantity& quantity,
                    std::vector<double>& numbers) {
  for (const Value& item : input::as_list(list, path)) {
    if (item.kind == Value::Kind::list) {
      append_numbers(item, path, quantity, numbers);
    } else {
      numbers.push_back(input::as_quantity(item, path, quantity));
    }
  }
}

sim::Pose read_pose(const Value& value) {
  // EuRoC has {cols, rows, data}, Kalibr a list of rows.
  std::vector<double> flat;
  if (value.kind == Value::Kind::map) {
    Reader reader(value, "T_BS");
    const Value* data = reader.find("data");
    if (!data) throw Error(value.where, "T_BS has no data; give its 16 numbers, row by row");
    append_numbers(*data, "T_BS.data", kOfTransform, flat);
  } else {
    append_numbers(value, "T_BS", kOfTransform, flat);
  }
  std::array<double, 16> matrix{};
  if (flat.size() != matrix.size()) {
    throw Error(value.where,
                "T_BS has " + std::to_string(flat.size()) + " numbers; give 16, row by row");
  }
  std::copy(flat.begin(), flat.end(), matrix.begin());
  try {
    return sequence::pose_of(matrix);
  } catch (const std::invalid_argument& error) {
    throw Error(value.where, std::string("T_BS ") + error.what() +
                                 "; give a rotation and a translation, and 0 0 0 1 below");
  }
}

void read_distortion(Reader& reader, Lens& lens) {
  const std::vector<std::string> models{"none", "radial-tangential", "radtan", "equidistant"};
  const std::size_t model = reader.choice("distortion_model", models).value_or(0);
  if (model == 0) return;
  const bool is_equidistant = models[model] == "equidistant";
  lens.distortion =
      is_equidistant ? Lens::Distortion::equidistant : Lens::Distortion::radial_tangential;
  const Value* list = reader.find("distortion_coefficients");
  if (!list) {
    throw Error(reader.where(),
                "there are no distortion_coefficients for the distortion_model; "
                "give four, or 'distortion_model: none'");
  }
  append_numbers(*list, "distortion_coefficients", kCoefficient, lens.coefficients);
  const std::size_t count = lens.coefficients.size();
  const bool is_known =
      count == 4 || (!is_equidistant && (count == 5 || count == 8 || count == 12 || count == 14));
  if (!is_known) {
    throw Error(list->where, "distortion_coefficients are " + std::to_string(count) +
                                 "; give four" +
                                 (is_equidistant ? "" : ", or 5, 8, 12 or 14 as OpenCV has them"));
  }
}

Lens read_lens(Reader& reader, const Value& intrinsics) {
  Lens lens;
  lens.source = intrinsics.where;
  reader.choice("camera_model", {"pinhole"});
  const std::vector<Value>& list = input::as_list(intrinsics, "intrinsics", 4);
  const auto number = [&](std::size_t i, const Quantity& quantity) {
    return input::as_quantity(list[i], "intrinsics." + std::to_string(i), quantity);
  };
  lens.fu_px = number(0, kFocal_px);
  lens.fv_px = number(1, kFocal_px);
  lens.cu_px = number(2, kCentre_px);
  lens.cv_px = number(3, kCentre_px);
  if (const Value* size = reader.find("resolution")) {
    const std::vector<Value>& pair = input::as_list(*size, "resolution", 2);
    const auto pixels = [&](std::size_t i) {
      return static_cast<int>(
          input::as_integer(pair[i], "resolution." + std::to_string(i), 1, kMostPixels));
    };
    lens.width_px = pixels(0);
    lens.height_px = pixels(1);
    lens.source = size->where;
  }
  read_distortion(reader, lens);
  return lens;
}

scenario::ImuNoise read_noise(Reader& reader) {
  scenario::ImuNoise noise;
  const auto read = [&](const char* key, double& value) {
    if (!reader.find(key)) {
      throw Error(reader.where(), std::string(key) + " is missing; give all four of Kalibr's");
    }
    reader.read(key, kNoise, value);
  };
  read("gyroscope_noise_density", noise.gyroscope_noise_density);
  read("gyroscope_random_walk", noise.gyroscope_random_walk);
  read("accelerometer_noise_density", noise.accelerometer_noise_density);
  read("accelerometer_random_walk", noise.accelerometer_random_walk);
  return noise;
}

}  // namespace

SensorYaml read_sensor_yaml(const std::filesystem::path& file) {
  const input::Source top{file.string(), 1};
  const Value yaml = input::parse_text(without_directive(input::read_file(file, kSensorFile)), top);
  if (yaml.kind != Value::Kind::map) {
    throw Error(top, "this is no map of keys; " + std::string(kSensorFile.remedy));
  }
  // Further keys may be present; they are ignored.
  Reader reader(yaml, "");
  SensorYaml sensor;
  for (const input::Entry& entry : yaml.entries) sensor.keys[entry.key] = entry.where;
  if (const Value* pose = reader.find("T_BS")) sensor.T_BS = read_pose(*pose);
  reader.read("rate_hz", kRate, sensor.rate_hz);
  if (const Value* intrinsics = reader.find("intrinsics")) {
    sensor.lens = read_lens(reader, *intrinsics);
  }
  if (reader.find("gyroscope_noise_density")) sensor.noise = read_noise(reader);
  return sensor;
}

}  // namespace lcs::replay
