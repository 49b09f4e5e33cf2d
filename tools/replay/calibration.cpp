
#include <algorithm>
#include <vector>

#include "scenarios/input/input_file.h"
#include "scenarios/input/reader.h"
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"

namespace lcs::replay {
namespace {

using input::Dimension;
using input::Error;
using input::Quantity;
using input::Reader;
using input::Value;

constexpr input::FileKind kCalibrationFile{
    input::kMebibyte,
    "give the YAML of Kalibr, OpenCV, ROS (camera_info), ORB-SLAM, VINS or OpenVINS"};

// Generous limits, which exclude impossible cameras and IMUs only.
constexpr Quantity kAny{Dimension::number, {-1e7, 1e7}};
constexpr Quantity kRate{Dimension::frequency, {0, 100000, true}};
constexpr Quantity kTimeShift{Dimension::time, {-1000, 1000}};
constexpr Quantity kNoise{Dimension::number, {0, 1000}};
constexpr int kMostSide_px = 65536;

/// OpenCV's FileStorage requires "%YAML:1.0", whose colon YAML does not allow, and marks its
/// matrices by a tag.
Value parse(const std::filesystem::path& file) {
  std::string text = input::read_file(file, kCalibrationFile);
  if (text.starts_with("%YAML:")) text.front() = '#';
  constexpr std::string_view kTag = "!!opencv-matrix";
  for (std::size_t at = 0; (at = text.find(kTag, at)) != text.npos;) {
    text.replace(at, kTag.size(), std::string(kTag.size(), ' '));
  }
  const input::Source top{file.string(), 1};
  Value yaml = input::parse_text(text, top);
  if (yaml.kind != Value::Kind::map) {
    throw Error(top, "this is no map of keys; {}", kCalibrationFile.remedy);
  }
  return yaml;
}

void append(const Value& list, const std::string& path, std::vector<double>& numbers) {
  for (const Value& item : input::as_list(list, path)) {
    if (item.kind == Value::Kind::list) {
      append(item, path, numbers);
    } else {
      numbers.push_back(input::as_quantity(item, path, kAny));
    }
  }
}

/// A list, a list of rows, or a matrix of OpenCV or EuRoC with its numbers in `data`.
std::vector<double> numbers_in(const Value& value, const std::string& path) {
  std::vector<double> numbers;
  if (value.kind == Value::Kind::map) {
    Reader matrix(value, path);
    const Value* data = matrix.find("data");
    if (!data) throw Error(value.where, path + " has no data; give its numbers, row by row");
    append(*data, path + ".data", numbers);
  } else {
    append(value, path, numbers);
  }
  return numbers;
}

int pixels_in(const Value& value, const std::string& path) {
  return static_cast<int>(input::as_integer(value, path, 1, kMostSide_px));
}

sim::Pose pose_in(const Value& value, const std::string& path) {
  const std::vector<double> numbers = numbers_in(value, path);
  constexpr std::size_t kRows = 12, kWhole = 16;
  if (numbers.size() != kWhole && numbers.size() != kRows) {
    throw Error(value.where, "{} has {} numbers; give 16, row by row", path, numbers.size());
  }
  const Eigen::Map<const Eigen::Matrix<double, 3, 4, Eigen::RowMajor>> rows(numbers.data());
  const auto R = rotation_of(rows.leftCols<3>());
  const bool is_rigid = numbers.size() == kRows || (numbers[12] == 0 && numbers[13] == 0 &&
                                                    numbers[14] == 0 && numbers[15] == 1);
  if (!R || !is_rigid) {
    throw Error(value.where,
                "{} is no rigid transform; give a rotation and a translation, and 0 0 0 1 below",
                path);
  }
  return {*R, rows.col(3)};
}

using Names = std::initializer_list<const char*>;

/// Reads keys of one map under any of their names.
class Keys {
 public:
  Keys(const Value& map, const std::string& path) : reader_(map, path) {}

  const input::Source& where() const { return reader_.where(); }
  bool has(std::string_view key) { return reader_.find(key) != nullptr; }
  /// The first of the names that is a key; null if none is.
  const Value* any_of(Names names) {
    for (const char* name : names) {
      if (const Value* value = reader_.find(name)) {
        found_ = name;
        return value;
      }
    }
    return nullptr;
  }
  /// Of the first of the names that is a key; absent if none is.
  auto read(Names names, const auto& convert) {
    const Value* value = any_of(names);
    return value ? std::optional(convert(*value, path())) : std::nullopt;
  }
  std::optional<double> number(Names names, const Quantity& quantity = kAny) {
    return read(names, [&](const Value& value, const std::string& path) {
      return input::as_quantity(value, path, quantity);
    });
  }
  double require(const std::string& name) {
    const auto found = number({name.c_str()});
    return found ? *found : throw Error(where(), "{} is missing; give it", name);
  }
  int pixels(Names names) { return read(names, pixels_in).value_or(0); }
  std::vector<double> list(Names names) {
    return read(names, numbers_in).value_or(std::vector<double>{});
  }
  std::string text(Names names) { return read(names, input::as_text).value_or(""); }
  std::optional<sim::Pose> pose(Names names) { return read(names, pose_in); }
  /// Of the key that was found last.
  std::string path() const { return reader_.path_of(found_); }

 private:
  Reader reader_;
  std::string found_;
};

void set_size(Keys& keys, Names widths, Names heights, Lens& lens) {
  lens.width_px = keys.pixels(widths);
  lens.height_px = keys.pixels(heights);
}

/// \param model a tool's name of a distortion. \throws input::Error for one that is not supported.
void set_distortion(std::string model, std::vector<double> coefficients, const input::Source& where,
                    Lens& lens) {
  model = in_lower_case(model);
  std::ranges::replace(model, '-', '_');
  const auto is_one_of = [&](Names names) {
    return std::ranges::find(names, model) != names.end();
  };
  const bool is_bent = std::ranges::any_of(coefficients, [](double k) { return k != 0; });
  const std::size_t count = coefficients.size();
  if (is_one_of({"", "none"})) {
    if (is_bent) {
      throw Error(where, "its distortion has coefficients and no model; give distortion_model");
    }
    return;
  }
  const bool is_fisheye = is_one_of({"equidistant", "fisheye", "kannala_brandt", "kannalabrandt8"});
  if (!is_fisheye &&
      !is_one_of({"radial_tangential", "radtan", "plumb_bob", "rational_polynomial", "pinhole"})) {
    throw Error(where,
                "the distortion '{}' is not supported; give radtan (plumb_bob), "
                "rational_polynomial, equidistant or none",
                model);
  }
  if (count == 0 && model == "plumb_bob") return;  // ROS's rectified cameras
  const bool is_known =
      count == 4 || (!is_fisheye && (count == 5 || count == 8 || count == 12 || count == 14));
  if (!is_known) {
    throw Error(where, "the distortion has {} coefficients; give four{}", count,
                is_fisheye ? "" : ", or 5, 8, 12 or 14 as OpenCV has them");
  }
  lens.distortion =
      is_fisheye ? Lens::Distortion::equidistant : Lens::Distortion::radial_tangential;
  lens.coefficients = std::move(coefficients);
}

/// EuRoC's sensor.yaml, and a camera of Kalibr's or OpenVINS's camchain.
void read_listed(Keys& keys, SensorCalibration& calibration) {
  calibration.rate_hz = keys.number({"rate_hz", "update_rate"}, kRate);
  calibration.T_BS = keys.pose({"T_BS", "T_imu_cam"});
  if (const auto T_CS = keys.pose({"T_cam_imu"}); T_CS && !calibration.T_BS) {
    calibration.T_BS = T_CS->inverse();
  }
  calibration.time_offset_s = keys.number({"timeshift_cam_imu"}, kTimeShift);
  const Value* intrinsics = keys.any_of({"intrinsics"});
  if (!intrinsics) return;
  std::vector<double> numbers = numbers_in(*intrinsics, keys.path());
  const std::string model = keys.text({"camera_model"});
  const std::map<std::string, std::pair<std::size_t, const char*>> models{
      {"", {0, ""}}, {"pinhole", {0, ""}}, {"omni", {1, "xi, "}}, {"ds", {2, "xi, alpha, "}}};
  const auto found = models.find(model);
  if (found == models.end()) {
    throw Error(intrinsics->where,
                "the camera_model '{}' is not supported; give a pinhole, omni or ds", model);
  }
  const auto [before, names] = found->second;
  if (numbers.size() != before + 4) {
    throw Error(intrinsics->where, "intrinsics are {} numbers; give {}fu, fv, cu, cv",
                numbers.size(), names);
  }
  Lens& lens = calibration.lens.emplace(
      pinhole({numbers[before], numbers[before + 1], numbers[before + 2], numbers[before + 3]},
              intrinsics->where));
  if (before > 0) lens.xi = numbers[0];
  if (before > 1) lens.alpha = numbers[1];
  if (const Value* size = keys.any_of({"resolution"})) {
    const std::vector<Value>& pair = input::as_list(*size, keys.path(), 2);
    lens.width_px = pixels_in(pair[0], keys.path());
    lens.height_px = pixels_in(pair[1], keys.path());
    lens.source = size->where;
  }
  const std::vector<double> coefficients =
      keys.list({"distortion_coefficients", "distortion_coeffs"});
  set_distortion(keys.text({"distortion_model"}), coefficients, keys.where(), lens);
}

/// Kalibr's camchain: cam0, cam1, ..., each beside the one before it if it has no IMU.
void read_camchain(const Value& root, Keys& cameras, const std::string& camera,
                   SensorCalibration& calibration) {
  const std::string name = camera.starts_with("cam") ? camera : "cam0";
  const Value* value = cameras.any_of({name.c_str()});
  if (!value) {
    throw Error(root.where, "holds no camera {}; name one of its own (camera)", name);
  }
  Keys keys(*value, name);
  read_listed(keys, calibration);
  if (calibration.T_BS) return;
  const auto T_CP = keys.pose({"T_cn_cnm1"});  // of the camera before, P, in this one
  if (!T_CP || !name.starts_with("cam") || name.size() != 4 || name.back() < '1') return;
  std::string before = name;
  --before.back();
  SensorCalibration neighbour;
  read_camchain(root, cameras, before, neighbour);
  if (neighbour.T_BS) calibration.T_BS = *neighbour.T_BS * T_CP->inverse();
}

/// OpenCV's FileStorage with its matrix, and ROS's camera_info.
void read_matrix(Keys& keys, const Value& matrix, SensorCalibration& calibration) {
  const std::vector<double> K = numbers_in(matrix, keys.path());
  if (K.size() != 9) {
    throw Error(matrix.where, "the camera's matrix has {} numbers; give 9", K.size());
  }
  Lens& lens = calibration.lens.emplace(pinhole({K[0], K[4], K[2], K[5]}, matrix.where));
  set_size(keys, {"image_width", "image_Width", "width"},
           {"image_height", "image_Height", "height"}, lens);
  const std::vector<double> coefficients =
      keys.list({"distortion_coefficients", "Distortion_Coefficients", "distCoeffs", "dist_coeffs",
                 "distortion", "D", "d"});
  // OpenCV does not name its model, but has a flag for the fisheye.
  const std::string model = keys.text({"distortion_model"});
  const bool is_fisheye = keys.number({"fisheye_model"}).value_or(0) != 0;
  set_distortion(!model.empty() ? model
                 : is_fisheye   ? "equidistant"
                                : "plumb_bob",
                 coefficients, keys.where(), lens);
}

/// ORB-SLAM2 and 3: Camera.fx, or Camera1.fx, and a type.
void read_orb_slam(Keys& keys, const std::string& prefix, SensorCalibration& calibration) {
  const auto number = [&](const char* name) { return keys.require(prefix + name); };
  Lens& lens = calibration.lens.emplace(
      pinhole({number("fx"), number("fy"), number("cx"), number("cy")}, keys.where()));
  set_size(keys, {"Camera.width"}, {"Camera.height"}, lens);
  const std::string type = keys.text({"Camera.type"});
  const auto bend = [&](const char* model, Names names) {
    std::vector<double> k;
    for (const char* name : names) k.push_back(keys.number({(prefix + name).c_str()}).value_or(0));
    set_distortion(model, k, keys.where(), lens);
  };
  if (type == "KannalaBrandt8") {
    bend("equidistant", {"k1", "k2", "k3", "k4"});
  } else if (type == "" || type == "PinHole") {
    bend("radtan", {"k1", "k2", "p1", "p2", "k3"});
  } else if (type != "Rectified") {
    throw Error(keys.where(),
                "the Camera.type '{}' is not supported; give PinHole, KannalaBrandt8 or Rectified",
                type);
  }
  if (prefix == "Camera2.") return;  // its place is beside Camera1
  calibration.T_BS = keys.pose({"IMU.T_b_c1", "Tbc"});
}

/// camodocal, as in VINS: a model_type with its parameters.
void read_camodocal(Keys& keys, const std::string& type, SensorCalibration& calibration) {
  const struct {
    const char* type;
    Names intrinsics;
    const char *distortion, *bent_by;
    Names coefficients;
  } models[] = {
      {"PINHOLE", {"fx", "fy", "cx", "cy"}, "radtan", "distortion", {"k1", "k2", "p1", "p2"}},
      {"MEI", {"gamma1", "gamma2", "u0", "v0"}, "radtan", "distortion", {"k1", "k2", "p1", "p2"}},
      {"KANNALA_BRANDT",
       {"mu", "mv", "u0", "v0"},
       "equidistant",
       "projection",
       {"k2", "k3", "k4", "k5"}},
  };
  const auto model = std::ranges::find(models, type, [](const auto& one) { return one.type; });
  if (model == std::end(models)) {
    throw Error(keys.where(),
                "the model_type '{}' is not supported; give PINHOLE, MEI or KANNALA_BRANDT", type);
  }
  const auto numbers = [&](std::string part, Names names) {
    part += "_parameters";
    const Value* value = keys.any_of({part.c_str()});
    if (!value) throw Error(keys.where(), "{} is missing; give it", part);
    Keys of_part(*value, part);
    std::vector<double> all;
    for (const char* name : names) all.push_back(of_part.require(name));
    return all;
  };
  const std::vector<double> K = numbers("projection", model->intrinsics);
  Lens& lens = calibration.lens.emplace(pinhole({K[0], K[1], K[2], K[3]}, keys.where()));
  set_size(keys, {"image_width"}, {"image_height"}, lens);
  if (type == "MEI") lens.xi = numbers("mirror", {"xi"}).front();
  set_distortion(model->distortion, numbers(model->bent_by, model->coefficients), keys.where(),
                 lens);
}

/// Four densities of Kalibr, VINS or ORB-SLAM; absent if there is none of them.
std::optional<scenario::ImuNoise> read_noise(Keys& keys) {
  scenario::ImuNoise noise;
  const struct {
    Names names;
    double& value;
  } densities[] = {
      {{"gyroscope_noise_density", "gyr_n", "IMU.NoiseGyro"}, noise.gyroscope_noise_density},
      {{"gyroscope_random_walk", "gyr_w", "IMU.GyroWalk"}, noise.gyroscope_random_walk},
      {{"accelerometer_noise_density", "acc_n", "IMU.NoiseAcc"}, noise.accelerometer_noise_density},
      {{"accelerometer_random_walk", "acc_w", "IMU.AccWalk"}, noise.accelerometer_random_walk},
  };
  int count = 0;
  const char* missing = nullptr;
  for (const auto& [names, value] : densities) {
    if (const auto number = keys.number(names, kNoise)) {
      value = *number;
      ++count;
    } else {
      missing = *names.begin();
    }
  }
  if (count == 0) return std::nullopt;
  if (missing) throw Error(keys.where(), "{} is missing; give all four", missing);
  return noise;
}

/// \param is_named whether another calibration names this one, which then names no third.
SensorCalibration read(const std::filesystem::path& file, const std::string& camera,
                       bool is_named) {
  const Value yaml = parse(file);
  SensorCalibration calibration;
  for (const input::Entry& entry : yaml.entries) calibration.keys[entry.key] = entry.where;
  Keys keys(yaml, "");  // further keys may be present; they are ignored
  const std::string second = camera == "cam1" ? "Camera2.fx" : "";
  const char* const its_file = camera == "cam1" ? "cam1_calib" : "cam0_calib";  // VINS-Fusion
  const Value* own_file = keys.any_of({its_file});
  if (const Value* imu = keys.any_of({"imu0"})) {
    Keys inner(*imu, "imu0");
    calibration.noise = read_noise(inner);
    calibration.rate_hz = inner.number({"update_rate"}, kRate);
  } else {
    calibration.noise = read_noise(keys);
  }
  calibration.time_offset_s = keys.number({"td"}, kTimeShift);
  calibration.has_cameras = keys.has("cam0") || own_file || keys.has("Camera2.fx");
  if (keys.has("cam0")) {
    read_camchain(yaml, keys, camera, calibration);
  } else if (own_file) {
    if (is_named) {
      throw Error(own_file->where,
                  "{} names a further calibration, and this one is itself named by a calibration; "
                  "name the camera's own file there",
                  its_file);
    }
    const std::string name = input::as_text(*own_file, its_file);
    calibration.lens = read(file.parent_path() / name, "", true).lens;
    calibration.T_BS = keys.pose({camera == "cam1" ? "body_T_cam1" : "body_T_cam0"});
  } else if (const std::string type = keys.text({"model_type"}); !type.empty()) {
    read_camodocal(keys, type, calibration);
    calibration.T_BS = keys.pose({"body_T_cam0"});
  } else if (!second.empty() && keys.has(second)) {
    read_orb_slam(keys, "Camera2.", calibration);
  } else if (keys.has("Camera1.fx")) {
    read_orb_slam(keys, "Camera1.", calibration);
  } else if (keys.has("Camera.fx")) {
    read_orb_slam(keys, "Camera.", calibration);
  } else if (const Value* matrix =
                 keys.any_of({"camera_matrix", "Camera_Matrix", "cameraMatrix", "K", "k"})) {
    read_matrix(keys, *matrix, calibration);
  } else {
    read_listed(keys, calibration);
  }
  if (!calibration.lens && !calibration.noise && !calibration.T_BS && !calibration.rate_hz) {
    throw Error({file.string(), 1}, "holds no calibration that is known; {}",
                kCalibrationFile.remedy);
  }
  return calibration;
}

}  // namespace

SensorCalibration read_calibration(const std::filesystem::path& file, const std::string& camera) {
  return read(file, camera, false);
}

}  // namespace lcs::replay
