// KITTI raw: image_0X/ and oxts/ of one drive; the calibration files lie in the folder of the date.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "scenarios/input_file.h"
#include "tools/bench/csv.h"
#include "tools/replay/navigation.h"
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// A state of 30 numbers, or a calibration.
constexpr scenario::FileKind kSmallText{scenario::kMebibyte, "give the file as KITTI has it"};

/// Line k is of item k; none where a line is no time.
std::vector<std::optional<std::int64_t>> read_times(const fs::path& file, Tally& tally) {
  const TextTable table = read_table(file, ' ');
  std::vector<std::optional<std::int64_t>> times;
  for (const TextTable::Row& row : table.rows) {
    times.push_back(row.fields.size() == 2 ? calendar_time_in(row.fields[0], row.fields[1])
                                           : std::nullopt);
    if (!times.back()) tally.add("rows cannot be read and are left out", table.at(row));
  }
  return times;
}

/// 30 numbers a file: lat lon alt roll pitch yaw vn ve vf vl vu ...; the world is east, north, up.
std::vector<NavigationState> read_oxts(const fs::path& folder, Tally& tally) {
  constexpr std::size_t kNumbers = 30;
  enum Column : std::size_t { kRoll = 3, kPitch, kYaw, kNorth, kEast, kUp = 10 };
  const auto times = read_times(folder / "timestamps.txt", tally);
  std::vector<NavigationState> states;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!times[i]) continue;
    const fs::path file = folder / "data" / fmt::format("{:010}.txt", i);
    std::vector<double> numbers;
    try {
      std::istringstream words(scenario::read_file(file, kSmallText));
      for (std::string word; words >> word;) {
        if (const auto number = bench::number_in<double>(word)) numbers.push_back(*number);
      }
    } catch (const scenario::Error&) {
      numbers.clear();  // and so it is counted
    }
    if (numbers.size() != kNumbers || !is_speed(numbers[kEast], numbers[kNorth], numbers[kUp])) {
      tally.add("states of the navigation unit are missing or cannot be read", file.string());
      continue;
    }
    states.push_back({*times[i],
                      from_rpy(numbers[kRoll], numbers[kPitch], numbers[kYaw]),
                      {numbers[kEast], numbers[kNorth], numbers[kUp]}});
  }
  return states;
}

/// "NAME: numbers" a line.
class CalibrationFile {
 public:
  explicit CalibrationFile(const fs::path& file) : file_(file) {
    scenario::InputFile input(file, kSmallText);
    for (std::string line; input.next_line(line);) {
      const std::size_t colon = line.find(':');
      if (colon == line.npos) continue;
      std::istringstream words(line.substr(colon + 1));
      std::vector<double>& numbers = values_[line.substr(0, colon)];
      for (double number; words >> number;) numbers.push_back(number);
    }
  }
  /// \throws std::runtime_error unless there are as many numbers.
  const std::vector<double>& numbers(const std::string& name, std::size_t count) const {
    const auto found = values_.find(name);
    if (found == values_.end() || found->second.size() != count) {
      throw scenario::Error({file_.string(), 0},
                            fmt::format("{} is missing, or is not {} numbers; {}", name, count,
                                        kSmallText.remedy));
    }
    return found->second;
  }
  Matrix3d matrix(const std::string& name) const {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(numbers(name, 9).data());
  }
  sim::Pose pose() const {
    return {matrix("R"), Eigen::Map<const Vector3d>(numbers("T", 3).data())};
  }

 private:
  fs::path file_;
  std::map<std::string, std::vector<double>> values_;
};

struct Camera {
  Lens lens;
  sim::Pose T_BC;
};

/// Of the rectified pictures ("sync"): P_rect is [K | K t] of the camera in the rectified frame of
/// camera 0.
std::optional<Camera> read_calibration(const fs::path& drive, const std::string& number) {
  for (const fs::path& folder : {drive, fs::absolute(drive / "..").lexically_normal()}) {
    if (!fs::exists(folder / "calib_cam_to_cam.txt")) continue;
    const CalibrationFile cameras(folder / "calib_cam_to_cam.txt");
    const std::vector<double>& P = cameras.numbers("P_rect_" + number, 12);
    Camera camera;
    camera.lens.fu_px = P[0];
    camera.lens.fv_px = P[5];
    camera.lens.cu_px = P[2];
    camera.lens.cv_px = P[6];
    const sim::Pose T_velo_imu = CalibrationFile(folder / "calib_imu_to_velo.txt").pose();
    const sim::Pose T_cam_velo = CalibrationFile(folder / "calib_velo_to_cam.txt").pose();
    const sim::Pose rectify{cameras.matrix("R_rect_00"), Vector3d::Zero()};
    const sim::Pose beside{Matrix3d::Identity(), {P[3] / P[0], P[7] / P[5], P[11]}};
    camera.T_BC = (beside * (rectify * (T_cam_velo * T_velo_imu))).inverse();
    return camera;
  }
  return std::nullopt;
}

/// image_00 to image_03; the first there is if none is named.
std::string camera_in(const ReadOptions& options) {
  if (!options.camera.empty()) return options.camera;
  for (const char* name : {"image_02", "image_00", "image_03", "image_01"}) {
    if (fs::is_directory(options.folder / name)) return name;
  }
  return "image_02";
}

}  // namespace

bool is_kitti(const fs::path& folder) {
  return fs::is_directory(folder / "oxts") &&
         fs::exists(folder / camera_in({.folder = folder}) / "timestamps.txt");
}

Recorded read_kitti(const ReadOptions& options) {
  const std::string name = camera_in(options);
  const fs::path camera_folder = options.folder / name;
  if (!name.starts_with("image_") || !fs::exists(camera_folder / "timestamps.txt")) {
    throw std::runtime_error(fmt::format("{} is not there; name a camera by --camera, as image_02",
                                         (camera_folder / "timestamps.txt").string()));
  }
  Recorded recorded;
  const auto times = read_times(camera_folder / "timestamps.txt", recorded.tally);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!times[i]) continue;
    recorded.frames.push_back({*times[i], camera_folder / "data" / fmt::format("{:010}.png", i)});
  }
  put_in_order(recorded.frames, camera_folder / "timestamps.txt", recorded.tally);
  sim::Pose T_BC{camera_mount(options.mount_rpy_rad.value_or(Vector3d::Zero())), Vector3d::Zero()};
  if (const auto camera = read_calibration(options.folder, name.substr(name.find('_') + 1))) {
    recorded.lens = camera->lens;
    T_BC = camera->T_BC;
  }
  move_by_navigation(read_oxts(options.folder / "oxts", recorded.tally), T_BC, recorded);
  return recorded;
}

}  // namespace lcs::replay
