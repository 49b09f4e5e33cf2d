// Oxford RobotCar: mono_*/ and stereo/*/ with raw pictures, <camera>.timestamps, gps/ins.csv. A
// recording has no calibration.
#include <fmt/format.h>

#include <algorithm>
#include <opencv2/imgproc.hpp>
#include <stdexcept>

#include "tools/replay/motion_source.h"
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

struct CameraKind {
  const char* name;
  int demosaic;  ///< OpenCV names a pattern by its second row: its BG is RGGB elsewhere
  bool looks_ahead;
};
constexpr CameraKind kCameras[] = {
    {"stereo/centre", cv::COLOR_BayerGR2BGR, true}, {"stereo/left", cv::COLOR_BayerGR2BGR, true},
    {"stereo/right", cv::COLOR_BayerGR2BGR, true},  {"mono_rear", cv::COLOR_BayerBG2BGR, false},
    {"mono_left", cv::COLOR_BayerBG2BGR, false},    {"mono_right", cv::COLOR_BayerBG2BGR, false},
};

/// For example stereo.timestamps for stereo/centre.
fs::path list_of(const fs::path& folder, const CameraKind& camera) {
  const std::string name = camera.name;
  return folder / (name.substr(0, name.find('/')) + ".timestamps");
}

const CameraKind* first_camera(const fs::path& folder) {
  const auto found = std::ranges::find_if(kCameras, [&](const CameraKind& camera) {
    return fs::is_directory(folder / camera.name) && fs::exists(list_of(folder, camera));
  });
  return found == std::end(kCameras) ? nullptr : found;
}

const CameraKind& camera_of(const scenario::RecordingSource& asked) {
  if (asked.camera.empty()) {
    if (const CameraKind* first = first_camera(asked.path)) return *first;
    throw std::runtime_error(
        fmt::format("{} has no camera with its list of pictures; give one, as stereo/centre with "
                    "stereo.timestamps",
                    asked.path.string()));
  }
  const auto found = std::ranges::find(kCameras, asked.camera, &CameraKind::name);
  if (found == std::end(kCameras)) {
    throw input::Error(asked.source,
                       "the camera is '{}'; give stereo/left, stereo/centre, stereo/right, "
                       "mono_left, mono_right or mono_rear",
                       asked.camera);
  }
  return *found;
}

/// Converts from the unit's axes (north, east, down; ahead, right, down) to ours (east, north, up;
/// ahead, left, up).
std::vector<NavigationState> read_ins(const fs::path& file, Tally& tally) {
  const TextTable table = read_table(file);
  if (table.header.empty()) {
    throw std::runtime_error(
        fmt::format("{} has no header to find its columns by; give the file as RobotCar has it",
                    file.string()));
  }
  const auto column = [&](const char* name) { return table.column(name, 0); };
  const std::size_t columns[] = {column("velocity_north"), column("velocity_east"),
                                 column("velocity_down"),  column("roll"),
                                 column("pitch"),          column("yaw")};
  const std::size_t time = column("timestamp");
  Eigen::Matrix3d R_enu_ned, R_frd_flu;
  R_enu_ned << 0, 1, 0, 1, 0, 0, 0, 0, -1;
  R_frd_flu << 1, 0, 0, 0, -1, 0, 0, 0, -1;
  std::vector<NavigationState> states;
  for (const TextTable::Row& row : table.rows) {
    const auto t_ns = time_in(TextTable::field(row, time), kMicrosecond_ns);
    const auto numbers = TextTable::numbers(row, columns);
    const Vector3d v_ned_mps = numbers ? Vector3d(numbers->data()) : Vector3d::Zero();
    if (!t_ns || !numbers || !is_speed(v_ned_mps)) {
      tally.add("rows cannot be read and are left out", table.at(row));
      continue;
    }
    const Eigen::Matrix3d R_ned_frd = sim::rotation_of_rpy(Vector3d(numbers->data() + 3));
    states.push_back(
        {*t_ns, Eigen::Quaterniond(R_enu_ned * R_ned_frd * R_frd_flu), R_enu_ned * v_ned_mps});
  }
  return states;
}

}  // namespace

bool is_robotcar(const fs::path& folder) {
  return first_camera(folder) != nullptr;
}

Recorded read_robotcar(const scenario::RecordingSource& asked, bool) {
  const CameraKind& camera = camera_of(asked);
  Recorded recorded;
  recorded.format.demosaic = camera.demosaic;
  const auto picture = [&](const TextTable::Row& row) {
    return asked.path / camera.name / (row.fields[0] + ".png");
  };
  take_list(read_table(list_of(asked.path, camera)), kMicrosecond_ns, picture, recorded);
  if (motion_is_asked(asked)) return recorded;
  if (!camera.looks_ahead && !asked.mount_rpy_rad) {
    recorded.lacks.push_back(
        fmt::format("where {} looks (mount, as 0, 0, 180 for backwards)", camera.name));
  }
  recorded.took.insert("mount");
  const sim::Pose T_BC{camera_mount(asked.mount_rpy_rad.value_or(Vector3d::Zero()))};
  move_by_navigation(read_ins(asked.path / "gps" / "ins.csv", recorded.tally), T_BC, recorded);
  return recorded;
}

}  // namespace lcs::replay
