// KITTI raw: image_0X/ and oxts/ of one drive; the date's folder holds the calibration files.
// KITTI odometry: image_0/ to image_3/, calib.txt, times.txt and, for some sequences, poses of
// camera 0, beside the pictures or, as in the benchmark, in poses/NN.txt for sequences/NN/.
// KITTI tracking: image_02/NNNN/, oxts/NNNN.txt and calib/NNNN.txt in training/ or testing/.
// KITTI-360: data_2d_raw/DRIVE/image_0X/data_rect/, beside calibration/ and data_poses/DRIVE/.

#include <map>
#include <span>

#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

constexpr std::string_view kPrefix = "image_";
constexpr const char* kRemedy = "give the file as KITTI has it";

/// A calibration file, one "NAME: numbers" a line. Its functions throw input::Error if a line is
/// missing, has another length, or is a matrix that is no rotation.
class KittiCalibration {
 public:
  /// Lines without a name are called P0, P1, ... \throws input::Error if it cannot be read.
  explicit KittiCalibration(const fs::path& file) : file_(file) {
    int unnamed = 0;
    for (const TextTable::Row& row : read_table(file).rows) {
      const bool is_named = !row.number(0);
      std::string name = is_named ? row.fields[0] : fmt::format("P{}", unnamed++);
      if (name.ends_with(':')) name.pop_back();  // KITTI tracking names some without a colon
      const std::size_t first = is_named ? 1 : 0;
      const auto numbers = row.numbers(first, row.fields.size() - first);
      if (numbers) values_[name] = *numbers;
    }
  }

  Eigen::Matrix3d rotation(const std::string& name) const {
    return rotation_in(name, Eigen::Map<const Eigen::Matrix3d>(numbers(name, 9)).transpose());
  }
  /// The transform of a line with 12 numbers, three rows of a matrix.
  sim::Pose pose(const std::string& name) const {
    const Eigen::Map<const Rows> rows(numbers(name, Rows::SizeAtCompileTime));
    return {rotation_in(name, rows.leftCols<3>()), rows.col(3)};
  }
  /// The transform of the lines R and T.
  sim::Pose pose() const { return {rotation("R"), Vector3d(numbers("T", 3))}; }
  /// K of the projection [K | K t] of rectified pictures, in pixels, with their size if S_rect_NN
  /// states it.
  Lens lens(const std::string& name) const {
    const double* P = numbers(name, Rows::SizeAtCompileTime);
    Lens lens = pinhole({P[0], P[5], P[2], P[6]}, {file_.string(), 0});
    constexpr std::string_view kRectified = "P_rect_";
    if (!name.starts_with(kRectified)) return lens;
    const std::string size = "S_rect_" + name.substr(kRectified.size());
    if (values_.contains(size)) {
      lens.width_px = static_cast<int>(numbers(size, 2)[0]);
      lens.height_px = static_cast<int>(numbers(size, 2)[1]);
    }
    return lens;
  }
  /// t of that projection: transforms points from the common rectified frame to the camera.
  sim::Pose beside(const std::string& name) const {
    const double* P = numbers(name, Rows::SizeAtCompileTime);
    return {Eigen::Matrix3d::Identity(), {P[3] / P[0], P[7] / P[5], P[11]}};
  }

 private:
  using Rows = Eigen::Matrix<double, 3, 4, Eigen::RowMajor>;

  const double* numbers(const std::string& name, std::size_t count) const {
    const auto found = values_.find(name);
    if (found != values_.end() && found->second.size() == count) return found->second.data();
    refuse({file_}, "{} is missing, or is not {} numbers; {}", name, count, kRemedy);
  }
  Eigen::Matrix3d rotation_in(const std::string& name, const Eigen::Matrix3d& rounded) const {
    if (const auto R = rotation_of(rounded)) return *R;
    refuse({file_}, "{} is no rotation; {}", name, kRemedy);
  }

  fs::path file_;
  std::map<std::string, std::vector<double>> values_;
};

/// The folder of the asked camera, or else of the first of the names that is there.
/// \throws input::Error if it is not there.
fs::path camera_folder(const RecordingSource& asked, std::span<const char* const> names) {
  const auto first = std::ranges::find_if(
      names, [&](const char* name) { return fs::is_directory(asked.path / name); });
  const fs::path folder = asked.path / (!asked.camera.empty()  ? asked.camera
                                        : first != names.end() ? *first
                                                               : names.front());
  if (folder.filename().string().starts_with(kPrefix) && fs::is_directory(folder)) return folder;
  refuse(asked.source, "{} is not there; name a camera, as {}", folder.string(), names.front());
}

constexpr const char* kDriveCameras[] = {"image_02", "image_00", "image_03", "image_01"};
constexpr const char* kOdometryCameras[] = {"image_0", "image_2", "image_1", "image_3"};

bool has_any(const fs::path& folder, std::span<const char* const> names) {
  return std::ranges::any_of(names,
                             [&](const char* name) { return fs::is_directory(folder / name); });
}

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

/// A row of 30 numbers, lat lon alt roll pitch yaw vn ve vf vl vu ..., as a state at no time;
/// absent if malformed. The world frame is east, north, up.
std::optional<NavigationState> state_in(const TextTable::Row& row) {
  constexpr std::size_t kNumbers = 30;
  enum Column : std::size_t { kRoll = 3, kPitch, kYaw, kNorth, kEast, kUp = 10 };
  const auto numbers = row.numbers(0, kNumbers);
  if (!numbers) return std::nullopt;
  const std::vector<double>& n = *numbers;
  const Vector3d v_mps(n[kEast], n[kNorth], n[kUp]);
  if (!is_speed(v_mps)) return std::nullopt;
  return NavigationState{0, sim::quaternion_of_rpy({n[kRoll], n[kPitch], n[kYaw]}), v_mps};
}

constexpr const char* kNoState = "states of the navigation unit are missing or cannot be read";

/// A state a file.
std::vector<NavigationState> read_oxts(const fs::path& folder, Tally& tally) {
  const auto times = read_times(folder / "timestamps.txt", tally);
  std::vector<NavigationState> states;
  for (std::size_t i = 0; i < times.size(); ++i) {
    if (!times[i]) continue;
    const fs::path file = folder / "data" / fmt::format("{:010}.txt", i);
    std::optional<NavigationState> state;
    try {
      const TextTable table = read_table(file);
      if (table.rows.size() == 1) state = state_in(table.rows.front());
    } catch (const input::Error&) {
      // counted below
    }
    if (state) {
      state->t_ns = *times[i];
      states.push_back(*state);
    } else {
      tally.add(kNoState, file.string());
    }
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

void time_frames(const fs::path& file, Recorded& recorded) {
  const TextTable table = read_table(file);
  const auto use = [&](RecordedFrame& frame, std::size_t row) {
    const auto t_ns = time_in(table.rows[row].fields.front(), kSecond_ns);
    if (!t_ns)
      recorded.tally.add("rows cannot be read and are left out", table.at(table.rows[row]));
    frame.t_ns = t_ns.value_or(0);
    return t_ns.has_value();
  };
  take_rows(file, table.rows.size(), "time", recorded, use);
  put_in_order(recorded.frames, file, recorded.tally);
}

/// The poses beside the pictures, or at the benchmark's place; "" if in neither.
fs::path poses_of(const fs::path& folder) {
  const fs::path whole = fs::absolute(folder).lexically_normal();
  const fs::path name = whole.has_filename() ? whole.filename() : whole.parent_path().filename();
  for (const fs::path& file :
       {folder / "poses.txt", folder / ".." / ".." / "poses" / (name.string() + ".txt")}) {
    if (fs::exists(file)) return file;
  }
  return "";
}

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
      refuse({}, "{} holds several sequences; give one of them, as {}", folder.string(),
             one.pictures.string());
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

bool is_kitti(const fs::path& folder) {
  return fs::is_directory(folder / "oxts" / "data") && has_any(folder, kDriveCameras);
}

Recorded read_kitti(const RecordingSource& asked, bool) {
  const fs::path camera = camera_folder(asked, kDriveCameras);
  const std::string name = camera.filename().string();
  Recorded recorded;
  fs::path clock = camera / "timestamps.txt";
  if (!fs::exists(clock)) {
    clock = asked.path / "oxts" / "timestamps.txt";
    recorded.tally.add("cameras have no times of their own: the times of the navigation are used",
                       name);
  }
  take_frames(clock, camera / "data", recorded);
  sim::Pose T_BC{camera_mount(asked.mount_rpy_rad.value_or(Vector3d::Zero())), Vector3d::Zero()};
  take_calibration(asked.path, name.substr(kPrefix.size()), recorded.lens, T_BC);
  if (motion_is_asked(asked)) return recorded;
  move_by_navigation(read_oxts(asked.path / "oxts", recorded.tally), T_BC, recorded);
  return recorded;
}

bool is_kitti_odometry(const fs::path& folder) {
  return fs::exists(folder / "calib.txt") && has_any(folder, kOdometryCameras);
}

Recorded read_kitti_odometry(const RecordingSource& asked, bool) {
  const fs::path camera = camera_folder(asked, kOdometryCameras);
  Recorded recorded;
  take_pictures(camera, "", recorded);
  recorded.numbers.first = 0;
  recorded.timed = fs::exists(asked.path / "times.txt");
  if (recorded.timed) time_frames(asked.path / "times.txt", recorded);
  const std::string name = camera.filename().string();
  const std::string projection = fmt::format("P{}", name.substr(kPrefix.size()));
  const KittiCalibration calibration(asked.path / "calib.txt");
  recorded.lens = calibration.lens(projection);
  const fs::path poses = poses_of(asked.path);
  if (motion_is_asked(asked) || poses.empty()) return recorded;
  // Without times and a rate it will be rejected later, for that reason.
  if (!recorded.timed) time_by(asked.fps.value_or(1), recorded);
  // The poses are of camera 0.
  move_by_poses(asked, poses, true, recorded, {}, calibration.beside(projection).inverse());
  return recorded;
}

bool is_kitti_tracking(const fs::path& folder) {
  return fs::is_directory(folder) && tracked_in(folder).has_value();
}

Recorded read_kitti_tracking(const RecordingSource& asked, bool) {
  const std::optional<Tracked> sequence = tracked_in(asked.path);
  if (!sequence) {
    refuse(asked.source,
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
  const TextTable table = read_table(oxts);
  for (const TextTable::Row& row : table.rows) {
    lines.resize(static_cast<std::size_t>(row.line));
    lines.back() = state_in(row);
    if (!lines.back()) recorded.tally.add(kNoState, table.at(row));
  }
  std::vector<NavigationState> states;
  take_rows(oxts, lines.size(), "state", recorded, [&](RecordedFrame& frame, std::size_t row) {
    if (!lines[row]) return true;  // between two states the motion is linear
    states.push_back(*lines[row]);
    states.back().t_ns = frame.t_ns;
    return true;
  });
  const sim::Pose T_BC = T_BC_of(calibration, projection, "R_rect", calibration.pose("Tr_velo_cam"),
                                 calibration.pose("Tr_imu_velo"));
  move_by_navigation(std::move(states), T_BC, recorded);
  return recorded;
}

bool is_kitti_360(const fs::path& folder) {
  return fs::is_directory(rectified_in(folder, ""));
}

Recorded read_kitti_360(const RecordingSource& asked, bool) {
  const std::string camera = asked.camera.empty() ? "image_00" : asked.camera;
  const fs::path pictures = rectified_in(asked.path, camera);
  if (!fs::is_directory(pictures)) {
    refuse(asked.source, "{} is not there; name a camera, as image_00", pictures.string());
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
  move_by_poses(asked, poses, true, recorded);
  return recorded;
}

}  // namespace lcs::replay
