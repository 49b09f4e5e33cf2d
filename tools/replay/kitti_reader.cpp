// KITTI raw: image_0X/ and oxts/ of one drive; the date's folder holds the calibration files.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <sstream>
#include <stdexcept>

#include "tools/files/csv.h"
#include "tools/input/input_file.h"
#include "tools/replay/kitti_calibration.h"
#include "tools/replay/navigation.h"
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

/// A state has 30 numbers.
constexpr input::FileKind kSmallText{input::kMebibyte, "give the file as KITTI has it"};

/// Line k belongs to item k; absent if malformed.
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

/// 30 numbers a file: lat lon alt roll pitch yaw vn ve vf vl vu ...; world frame east, north, up.
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
      std::istringstream words(input::read_file(file, kSmallText));
      for (std::string word; words >> word;) {
        if (const auto number = bench::number_in<double>(word)) numbers.push_back(*number);
      }
    } catch (const input::Error&) {
      numbers.clear();  // an empty list is counted as a fault below
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

struct Camera {
  Lens lens;
  sim::Pose T_BC;
};

/// Calibration of the rectified pictures ("sync"): P_rect is [K | K t] of the camera, in the
/// rectified frame of camera 0.
std::optional<Camera> read_calibration(const fs::path& drive, const std::string& number) {
  for (const fs::path& folder : {drive, fs::absolute(drive / "..").lexically_normal()}) {
    if (!fs::exists(folder / "calib_cam_to_cam.txt")) continue;
    const KittiCalibration cameras(folder / "calib_cam_to_cam.txt");
    Camera camera;
    camera.lens = cameras.lens("P_rect_" + number);
    const sim::Pose T_velo_imu = KittiCalibration(folder / "calib_imu_to_velo.txt").pose();
    const sim::Pose T_cam_velo = KittiCalibration(folder / "calib_velo_to_cam.txt").pose();
    const sim::Pose rectify{cameras.rotation("R_rect_00"), Vector3d::Zero()};
    camera.T_BC =
        (cameras.beside("P_rect_" + number) * (rectify * (T_cam_velo * T_velo_imu))).inverse();
    return camera;
  }
  return std::nullopt;
}

/// The named camera, or else the first one present of image_00 to image_03.
std::string camera_in(const scenario::Recorded& asked) {
  if (!asked.camera.empty()) return asked.camera;
  for (const char* name : {"image_02", "image_00", "image_03", "image_01"}) {
    if (fs::is_directory(asked.path / name)) return name;
  }
  return "image_02";
}

/// PNG as in KITTI, or JPEG as in smaller copies.
fs::path picture_of(const fs::path& data, std::size_t number) {
  const fs::path png = data / fmt::format("{:010}.png", number);
  const fs::path jpeg = data / fmt::format("{:010}.jpg", number);
  return !fs::exists(png) && fs::exists(jpeg) ? jpeg : png;
}

}  // namespace

bool is_kitti(const fs::path& folder) {
  scenario::Recorded asked;
  asked.path = folder;
  return fs::is_directory(folder / "oxts") && fs::is_directory(folder / camera_in(asked));
}

Recorded read_kitti(const scenario::Recorded& asked, bool) {
  const std::string name = camera_in(asked);
  const fs::path camera_folder = asked.path / name;
  if (!name.starts_with("image_") || !fs::is_directory(camera_folder)) {
    throw input::Error(asked.source, fmt::format("{} is not there; name a camera, as image_02",
                                                 camera_folder.string()));
  }
  Recorded recorded;
  fs::path clock = camera_folder / "timestamps.txt";
  if (!fs::exists(clock)) {
    clock = asked.path / "oxts" / "timestamps.txt";
    recorded.tally.add("cameras have no times of their own: those of the navigation are used",
                       name);
  }
  const auto times = read_times(clock, recorded.tally);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i]) recorded.frames.push_back({*times[i], picture_of(camera_folder / "data", i), i});
  }
  put_in_order(recorded.frames, clock, recorded.tally);
  sim::Pose T_BC{camera_mount(asked.mount_rpy_rad.value_or(Vector3d::Zero())), Vector3d::Zero()};
  if (const auto camera = read_calibration(asked.path, name.substr(name.find('_') + 1))) {
    recorded.lens = camera->lens;
    T_BC = camera->T_BC;
  }
  if (motion_is_asked(asked)) return recorded;
  move_by_navigation(read_oxts(asked.path / "oxts", recorded.tally), T_BC, recorded);
  return recorded;
}

}  // namespace lcs::replay
