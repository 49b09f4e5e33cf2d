// KITTI raw: image_0X/ and oxts/ of one drive; the date's folder holds the calibration files.
// KITTI tracking: image_02/NNNN/, oxts/NNNN.txt and calib/NNNN.txt in training/ or testing/.
// KITTI-360: data_2d_raw/DRIVE/image_0X/data_rect/, beside calibration/ and data_poses/DRIVE/.
#include <fmt/format.h>

#include <optional>
#include <sstream>
#include <stdexcept>

#include "scenarios/input/input_file.h"
#include "tools/files/csv.h"
#include "tools/replay/kitti_calibration.h"
#include "tools/replay/motion_source.h"
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

/// A state has 30 numbers.
constexpr input::FileKind kSmallText{input::kMebibyte, "give the file as KITTI has it"};

/// Line k belongs to item k; absent if malformed.
std::vector<std::optional<std::int64_t>> read_times(const fs::path& file, Tally& tally) {
  const TextTable table = read_table(file);
  std::vector<std::optional<std::int64_t>> times;
  for (const TextTable::Row& row : table.rows) {
    times.push_back(row.fields.size() == 2 ? calendar_time_in(row.fields[0], row.fields[1])
                                           : std::nullopt);
    if (!times.back()) tally.add("rows cannot be read and are left out", table.at(row));
  }
  return times;
}

/// The state of 30 numbers, at no time; absent if malformed.
std::optional<NavigationState> state_in(std::istream& words) {
  constexpr std::size_t kNumbers = 30;
  enum Column : std::size_t { kRoll = 3, kPitch, kYaw, kNorth, kEast, kUp = 10 };
  std::vector<double> numbers;
  for (std::string word; words >> word;) {
    if (const auto number = files::number_in<double>(word)) numbers.push_back(*number);
  }
  if (numbers.size() != kNumbers) return std::nullopt;
  const Vector3d v_mps(numbers[kEast], numbers[kNorth], numbers[kUp]);
  if (!is_speed(v_mps)) return std::nullopt;
  return NavigationState{
      0, sim::quaternion_of_rpy({numbers[kRoll], numbers[kPitch], numbers[kYaw]}), v_mps};
}

/// 30 numbers a file: lat lon alt roll pitch yaw vn ve vf vl vu ...; world frame east, north, up.
std::vector<NavigationState> read_oxts(const fs::path& folder, Tally& tally) {
  const auto times = read_times(folder / "timestamps.txt", tally);
  std::vector<NavigationState> states;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!times[i]) continue;
    const fs::path file = folder / "data" / fmt::format("{:010}.txt", i);
    std::string text;
    try {
      text = input::read_file(file, kSmallText);
    } catch (const input::Error&) {
      text.clear();  // counted below
    }
    std::istringstream words(text);
    auto state = state_in(words);
    if (!state) {
      tally.add("states of the navigation unit are missing or cannot be read", file.string());
      continue;
    }
    state->t_ns = *times[i];
    states.push_back(*state);
  }
  return states;
}

/// The pose of a camera, whose rectified pictures have this projection, on the IMU.
sim::Pose T_BC_of(const KittiCalibration& cameras, const std::string& projection,
                  const std::string& rectification, const sim::Pose& T_cam_velo,
                  const sim::Pose& T_velo_imu) {
  const sim::Pose rectify{cameras.rotation(rectification), Vector3d::Zero()};
  return (cameras.beside(projection) * (rectify * (T_cam_velo * T_velo_imu))).inverse();
}

/// Takes the calibration of the rectified pictures ("sync"), if there is one: P_rect is [K | K t]
/// of the camera, in the rectified frame of camera 0.
void take_calibration(const fs::path& drive, const std::string& number, std::optional<Lens>& lens,
                      sim::Pose& T_BC) {
  for (const fs::path& folder : {drive, fs::absolute(drive / "..").lexically_normal()}) {
    if (!fs::exists(folder / "calib_cam_to_cam.txt")) continue;
    const KittiCalibration cameras(folder / "calib_cam_to_cam.txt");
    lens = cameras.lens("P_rect_" + number);
    T_BC = T_BC_of(cameras, "P_rect_" + number, "R_rect_00",
                   KittiCalibration(folder / "calib_velo_to_cam.txt").pose(),
                   KittiCalibration(folder / "calib_imu_to_velo.txt").pose());
    return;
  }
}

constexpr const char* kDriveCameras[] = {"image_02", "image_00", "image_03", "image_01"};

/// PNG as in KITTI, or JPEG as in smaller copies.
fs::path picture_of(const fs::path& data, std::size_t number) {
  const fs::path png = data / fmt::format("{:010}.png", number);
  const fs::path jpeg = data / fmt::format("{:010}.jpg", number);
  return !fs::exists(png) && fs::exists(jpeg) ? jpeg : png;
}

/// Line k of `clock` is the time of picture k.
void take_frames(const fs::path& clock, const fs::path& data, Recorded& recorded) {
  const auto times = read_times(clock, recorded.tally);
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (times[i]) recorded.frames.push_back({*times[i], picture_of(data, i), i});
  }
  put_in_order(recorded.frames, clock, recorded.tally);
  number_frames(recorded, false);
}

}  // namespace

bool is_kitti(const fs::path& folder) {
  scenario::RecordingSource asked;
  asked.path = folder;
  return fs::is_directory(folder / "oxts" / "data") &&
         fs::is_directory(folder / kitti_camera(asked, kDriveCameras, "image_02"));
}

Recorded read_kitti(const scenario::RecordingSource& asked, bool) {
  const std::string name = kitti_camera(asked, kDriveCameras, "image_02");
  const fs::path camera_folder = asked.path / name;
  if (!name.starts_with("image_") || !fs::is_directory(camera_folder)) {
    throw input::Error(asked.source, "{} is not there; name a camera, as image_02",
                       camera_folder.string());
  }
  Recorded recorded;
  fs::path clock = camera_folder / "timestamps.txt";
  if (!fs::exists(clock)) {
    clock = asked.path / "oxts" / "timestamps.txt";
    recorded.tally.add("cameras have no times of their own: the times of the navigation are used",
                       name);
  }
  take_frames(clock, camera_folder / "data", recorded);
  sim::Pose T_BC{camera_mount(asked.mount_rpy_rad.value_or(Vector3d::Zero())), Vector3d::Zero()};
  take_calibration(asked.path, name.substr(name.find('_') + 1), recorded.lens, T_BC);
  if (motion_is_asked(asked)) return recorded;
  move_by_navigation(read_oxts(asked.path / "oxts", recorded.tally), T_BC, recorded);
  return recorded;
}

namespace {

/// A sequence of KITTI tracking: ROOT/image_02/NNNN.
struct Tracked {
  fs::path root, pictures;
  std::string camera, number;

  fs::path file(const char* folder) const { return root / folder / (number + ".txt"); }
};

/// The sequence whose pictures a folder holds, or the only one of ROOT.
std::optional<Tracked> tracked_in(const fs::path& folder) {
  const fs::path whole = fs::weakly_canonical(folder);
  const Tracked own{whole.parent_path().parent_path(), whole,
                    whole.parent_path().filename().string(), whole.filename().string()};
  if (own.camera.starts_with("image_") && fs::exists(own.file("calib"))) return own;
  std::optional<Tracked> only;
  std::error_code error;
  for (fs::directory_iterator entry(whole / "image_02", error), end; !error && entry != end;
       entry.increment(error)) {
    const Tracked one{whole, entry->path(), "image_02", entry->path().filename().string()};
    if (!entry->is_directory() || !fs::exists(one.file("calib"))) continue;
    if (only) {
      throw std::runtime_error(fmt::format("{} holds several sequences; give one of them, as {}",
                                           folder.string(), one.pictures.string()));
    }
    only = one;
  }
  return only;
}

/// The folder DRIVE/image_0X/data_rect of KITTI-360, as its pictures are rectified.
fs::path rectified_in(const fs::path& drive, const std::string& camera) {
  return drive / (camera.empty() ? "image_00" : camera) / "data_rect";
}

}  // namespace

bool is_kitti_tracking(const fs::path& folder) {
  return fs::is_directory(folder) && tracked_in(folder).has_value();
}

Recorded read_kitti_tracking(const scenario::RecordingSource& asked, bool) {
  const std::optional<Tracked> sequence = tracked_in(asked.path);
  if (!sequence) {
    throw input::Error(
        asked.source,
        "{} is no sequence of KITTI tracking; give training/image_02/NNNN beside training/calib",
        asked.path.string());
  }
  constexpr double kRate_hz = 10;  // all of KITTI is triggered at this rate
  Recorded recorded;
  take_pictures(sequence->pictures, "", recorded);
  recorded.numbers.first = 0;
  recorded.timed = false;
  recorded.fps = kRate_hz;
  if (!asked.fps && !asked.times) {
    recorded.tally.add("sequences have no times: KITTI's rate of 10 Hz is taken", sequence->number);
  }
  const std::string projection = fmt::format("P{}", sequence->camera.back());
  const KittiCalibration calibration(sequence->file("calib"));
  recorded.lens = calibration.lens(projection);
  const fs::path oxts = sequence->file("oxts");
  if (motion_is_asked(asked) || !fs::exists(oxts)) return recorded;
  if (asked.times) {
    recorded.lacks.emplace_back("how the camera moved at the times of the table (poses or imu)");
    return recorded;
  }
  time_by(asked.fps.value_or(kRate_hz), recorded);
  std::vector<std::optional<NavigationState>> lines;
  input::InputFile file(oxts, kSmallText);
  for (std::string line; file.next_line(line);) {
    std::istringstream words(line);
    lines.push_back(state_in(words));
    if (!lines.back()) {
      recorded.tally.add("states of the navigation unit are missing or cannot be read",
                         fmt::format("{}:{}", oxts.string(), lines.size()));
    }
  }
  std::vector<NavigationState> states;
  const auto rows = take_rows(oxts, lines.size(), "state", recorded);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (!lines[rows[i]]) continue;
    states.push_back(*lines[rows[i]]);
    states.back().t_ns = recorded.frames[i].t_ns;
  }
  const sim::Pose T_BC = T_BC_of(calibration, projection, "R_rect", calibration.pose("Tr_velo_cam"),
                                 calibration.pose("Tr_imu_velo"));
  move_by_navigation(std::move(states), T_BC, recorded);
  return recorded;
}

bool is_kitti_360(const fs::path& folder) {
  return fs::is_directory(rectified_in(folder, ""));
}

Recorded read_kitti_360(const scenario::RecordingSource& asked, bool) {
  const std::string camera = asked.camera.empty() ? "image_00" : asked.camera;
  const fs::path pictures = rectified_in(asked.path, camera);
  if (!fs::is_directory(pictures)) {
    throw input::Error(asked.source, "{} is not there; name a camera, as image_00",
                       pictures.string());
  }
  Recorded recorded;
  take_frames(pictures.parent_path() / "timestamps.txt", pictures, recorded);
  const fs::path whole = fs::weakly_canonical(asked.path);
  const fs::path root = whole.parent_path().parent_path();
  const fs::path calibration = root / "calibration" / "perspective.txt";
  if (fs::exists(calibration)) {
    recorded.lens =
        KittiCalibration(calibration).lens("P_rect_" + camera.substr(camera.size() - 2));
  }
  // Poses of the rectified camera 0: line k states its picture.
  const fs::path poses = root / "data_poses" / whole.filename() / "cam0_to_world.txt";
  if (motion_is_asked(asked) || !fs::exists(poses)) return recorded;
  if (camera != "image_00") {
    recorded.lacks.push_back(
        fmt::format("how {} moved (poses; {} is of image_00)", camera, poses.string()));
    return recorded;
  }
  scenario::RecordingSource by_poses = asked;
  by_poses.poses = poses;
  move_by_poses(by_poses, true, recorded);
  return recorded;
}

}  // namespace lcs::replay
