// TUM RGB-D: rgb.txt lists pictures with their times, groundtruth.txt the poses of the colour
// camera in a world frame with z up. A recording has no calibration.
// RPG's event-camera dataset (Mueggler et al., IJRR 2017): events.txt (t x y p), images.txt
// (t name), calib.txt (fx fy cx cy k1 k2 p1 p2 k3), groundtruth.txt (TUM's lines, of the camera),
// imu.txt (t ax ay az gx gy gz).
// Oxford RobotCar: mono_*/ and stereo/*/ with raw pictures, <camera>.timestamps, gps/ins.csv. A
// recording has no calibration.

#include <map>
#include <opencv2/imgproc.hpp>

#include "scenarios/input/input_file.h"
#include "tools/files/csv.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {
namespace {

constexpr const char* kEvents = "events.txt";
constexpr const char* kPictureList = "images.txt";
constexpr const char* kTumPictureList = "rgb.txt";
constexpr const char* kTruth = "groundtruth.txt";

std::vector<sim::Event> read_events(const fs::path& path, Tally& tally) {
  constexpr input::FileKind kKind{16 * input::kGibibyte, "give lines of t x y p"};
  input::InputFile file(path, kKind);
  std::vector<sim::Event> events;
  for (std::string line; file.next_line(line);) {
    std::vector<std::string_view> fields = files::words_of(line);
    fields.resize(4);
    const auto t_ns = time_in(fields[0], kSecond_ns);
    const auto x = files::number_in<std::uint16_t>(fields[1]);
    const auto y = files::number_in<std::uint16_t>(fields[2]);
    if (!t_ns || !x || !y || (fields[3] != "0" && fields[3] != "1")) {
      tally.add("events cannot be read and are left out",
                fmt::format("{}:{}", path.string(), file.here().line));
      continue;
    }
    if (!events.empty() && *t_ns < events.back().t_ns) {
      refuse(file.here(), "is earlier than the event before it; sort the lines by time");
    }
    events.push_back({*t_ns, *x, *y, fields[3] == "1"});
  }
  return events;
}

Lens read_lens(const fs::path& file) {
  const TextTable table = read_table(file);
  const auto numbers = table.rows.size() == 1 ? table.rows[0].numbers(0, 9) : std::nullopt;
  if (!numbers) refuse({file}, "has not one line of fx fy cx cy k1 k2 p1 p2 k3");
  const std::vector<double>& n = *numbers;
  Lens lens = pinhole({n[0], n[1], n[2], n[3]}, {file.string(), 0});
  const std::vector<double> k(n.begin() + 4, n.end());
  if (std::ranges::any_of(k, [](double c) { return c != 0; })) {
    lens.distortion = Lens::Distortion::radial_tangential;
    lens.coefficients = k;
  }
  return lens;
}

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

/// The camera of a name, or of none the first one that has its list of pictures; null: not there.
const CameraKind* camera_in(const fs::path& folder, const std::string& name) {
  const auto found = std::ranges::find_if(kCameras, [&](const CameraKind& camera) {
    return name.empty()
               ? fs::is_directory(folder / camera.name) && fs::exists(list_of(folder, camera))
               : name == camera.name;
  });
  return found == std::end(kCameras) ? nullptr : found;
}

const CameraKind& camera_of(const RecordingSource& asked) {
  if (const CameraKind* found = camera_in(asked.path, asked.camera)) return *found;
  if (asked.camera.empty()) {
    refuse({},
           "{} has no camera with its list of pictures; give one, as stereo/centre with "
           "stereo.timestamps",
           asked.path.string());
  }
  refuse(asked.source,
         "the camera is '{}'; give stereo/left, stereo/centre, stereo/right, mono_left, "
         "mono_right or mono_rear",
         asked.camera);
}

/// Converts from the unit's axes (north, east, down; ahead, right, down) to ours (east, north, up;
/// ahead, left, up).
std::vector<NavigationState> read_ins(const fs::path& file, Tally& tally) {
  const TextTable table = read_table(file);
  if (table.header.empty()) {
    refuse({}, "{} has no header to find its columns by; give the file as RobotCar has it",
           file.string());
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
    const auto t_ns = time_in(row.field(time), kMicrosecond_ns);
    const auto numbers = row.numbers(columns);
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

/// The row of each frame; null for a frame without one.
using RowOfFrame = std::vector<const TextTable::Row*>;

/// Whether a column holds whole numbers without a gap, in any order.
bool is_count(const TextTable& table, std::size_t column) {
  std::set<long> numbers;
  for (const TextTable::Row& row : table.rows) {
    const auto number = files::number_in<long>(row.field(column));
    if (!number || !numbers.insert(*number).second) return false;
  }
  return numbers.size() > 1 && *numbers.rbegin() - *numbers.begin() == std::ssize(numbers) - 1;
}

/// The rows by the names of pictures in a column; empty unless most rows name one, with or without
/// its ending. \throws input::Error if two rows name one picture, in other folders.
RowOfFrame rows_by_name(const TextTable& table, std::size_t column,
                        const std::vector<RecordedFrame>& frames) {
  std::map<std::string, std::size_t> frame_of_stem;
  for (std::size_t i = 0; i < frames.size(); ++i) {
    if (!frames[i].picture.empty()) frame_of_stem[frames[i].picture.stem().string()] = i;
  }
  RowOfFrame rows(frames.size());
  std::size_t named = 0;
  for (const TextTable::Row& row : table.rows) {
    const fs::path name = row.field(column);
    auto found = frame_of_stem.find(name.filename().string());
    if (found == frame_of_stem.end()) found = frame_of_stem.find(name.stem().string());
    if (found == frame_of_stem.end()) continue;
    ++named;
    const RecordedFrame& frame = frames[found->second];
    const TextTable::Row*& other = rows[found->second];
    const auto is_here = [&](const TextTable::Row& of) {
      const std::string whole = fmt::format("/{}", frame.picture.string());
      return whole.ends_with(fmt::format("/{}", of.field(column)));
    };
    if (!other || (is_here(row) && !is_here(*other))) {
      other = &row;
    } else if (!is_here(*other) && other->field(column) != name.string()) {
      refuse({table.file, row.line},
             "{} and {} may both be the picture {}; give the rows of its folder alone",
             other->field(column), name.string(), frame.name());
    }
  }
  // A count from 0 is not that of the names 1.png, 2.png, ...
  const bool is_partly = is_count(table, column) && std::ranges::count(rows, nullptr) > 0;
  return 2 * named > table.rows.size() && !is_partly ? rows : RowOfFrame{};
}

/// The rows by the numbers of pictures in a column; empty unless it has those of all pictures.
RowOfFrame rows_by_number(const TextTable& table, std::size_t column,
                          const std::vector<RecordedFrame>& frames) {
  std::map<std::size_t, const TextTable::Row*> row_of_number;
  for (const TextTable::Row& row : table.rows) {
    const auto number = files::number_in<std::size_t>(row.field(column));
    if (number) row_of_number.emplace(*number, &row);
  }
  RowOfFrame rows;
  for (const RecordedFrame& frame : frames) {
    const auto found = frame.named ? row_of_number.find(*frame.named) : row_of_number.end();
    if (found == row_of_number.end()) return {};
    rows.push_back(found->second);
  }
  return rows;
}

/// Whether a column has numbers that increase from picture to picture, except for a tenth of them.
bool increases(const RowOfFrame& rows, std::size_t column) {
  std::size_t falls = 0;
  std::optional<double> before;
  for (const TextTable::Row* row : rows) {
    const auto number = row ? row->number(column) : std::nullopt;
    falls += before && number && *number <= *before;
    if (number) before = number;
  }
  return before && 10 * falls <= rows.size();
}

/// The column of times where no header names it. \param names column of names, if there is one.
std::size_t time_column(const TextTable& table, std::optional<std::size_t> names,
                        const RowOfFrame& rows) {
  const std::size_t columns = table.rows.front().fields.size();
  const bool has_header = !table.header.empty() && !table.is_comment;
  for (std::size_t i = 0; i < columns && !has_header; ++i) {
    const bool is_number = table.rows.front().number(i).has_value();
    if (columns == 1 && is_number && (!is_count(table, i) || increases(rows, i))) return i;
    if (i != names && is_number && !is_count(table, i) && increases(rows, i)) return i;
  }
  if (names && !has_header && increases(rows, *names)) return *names;  // names that are times
  refuse({table.file, table.rows.front().line},
         "no column holds times that increase: {}; give a time for each picture, in a column "
         "called time [s], [ms], [us] or [ns]",
         table.columns());
}

}  // namespace

bool is_tum_rgbd(const fs::path& folder) {
  return fs::exists(folder / kTumPictureList);
}

Recorded read_tum_rgbd(const RecordingSource& asked, bool) {
  Recorded recorded;
  const auto picture = [&](const TextTable::Row& row) {
    return row.fields.size() > 1 ? asked.path / row.fields[1] : fs::path();
  };
  take_list(read_table(asked.path / kTumPictureList), kSecond_ns, picture, recorded);
  if (!motion_is_asked(asked) && fs::exists(asked.path / kTruth)) {
    move_by_poses(asked, asked.path / kTruth, true, recorded, Vector3d::UnitZ());
  }
  return recorded;
}

bool is_rpg_events(const fs::path& folder) {
  return fs::exists(folder / kEvents) && fs::exists(folder / kPictureList);
}

/// The layout does not state where the camera is on the IMU. The motion comes from the IMU if
/// `asked.calibration` states it, else from the truth.
Recorded read_rpg_events(const RecordingSource& asked, bool exact_motion) {
  Recorded recorded;
  const auto picture = [&](const TextTable::Row& row) {
    return row.fields.size() == 2 ? asked.path / row.fields[1] : fs::path();
  };
  take_list(read_table(asked.path / kPictureList), kSecond_ns, picture, recorded);
  recorded.events = read_events(asked.path / kEvents, recorded.tally);
  for (RecordedFrame& frame : recorded.frames) {
    const auto end = std::ranges::upper_bound(recorded.events, frame.t_ns, {}, &sim::Event::t_ns);
    frame.events = static_cast<std::size_t>(end - recorded.events.begin());
  }
  if (const fs::path file = asked.path / "calib.txt"; fs::exists(file))
    recorded.lens = read_lens(file);
  if (motion_is_asked(asked)) return recorded;
  const fs::path imu = asked.path / "imu.txt", truth = asked.path / kTruth;
  const bool is_on_imu =
      asked.calibration && read_calibration(*asked.calibration, asked.camera).T_BS;
  if (is_on_imu && !exact_motion && fs::exists(imu)) {
    SensorReadings readings;
    const TableTimes in_seconds{"s", kImuRate, kSecond_ns};
    readings.imu = read_imu_csv(imu, in_seconds, recorded.tally, {4, 5, 6, 1, 2, 3});
    move_by_readings(asked, imu, std::move(readings), recorded);
  } else if (fs::exists(truth)) {
    recorded.took.insert("ego_motion: truth");
    move_by_poses(asked, truth, true, recorded, Vector3d::UnitZ());
  }
  return recorded;
}

bool is_robotcar(const fs::path& folder) {
  return camera_in(folder, "") != nullptr;
}

Recorded read_robotcar(const RecordingSource& asked, bool) {
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

void time_by_table(const fs::path& file, const std::string& time_unit, Recorded& recorded) {
  const TextTable table = read_table(file);
  if (table.rows.empty()) {
    refuse({file}, "holds no time; give one for each picture");
  }
  RowOfFrame rows;
  std::optional<std::size_t> names;
  for (const auto& rows_by : {rows_by_name, rows_by_number}) {
    for (std::size_t i = 0; i < table.rows.front().fields.size() && rows.empty(); ++i) {
      rows = rows_by(table, i, recorded.frames);
      if (!rows.empty()) names = i;
    }
  }
  const std::size_t pictures = recorded.frames.size();
  if (!names) {
    take_rows(file, table.rows.size(), "time", recorded, [&](RecordedFrame&, std::size_t row) {
      rows.push_back(&table.rows[row]);
      return true;
    });
  }
  if (rows.size() < pictures) {
    refuse({file},
           "has {} times for {} pictures, and does not name them; give one for each picture, or a "
           "column with the names of the pictures",
           table.rows.size(), pictures);
  }
  const TableTimes times{time_unit, kCameraRate, {}};
  TimeColumn time;
  if (table.time_column()) {
    time = time_column_of(table, times, recorded.tally);
  } else {
    time.column = time_column(table, names, rows);
    time.unit_ns = times.unit_ns(table, time.column, recorded.tally);
  }
  std::vector<RecordedFrame> timed;
  for (std::size_t i = 0; i < recorded.frames.size(); ++i) {
    RecordedFrame& frame = recorded.frames[i];
    const TextTable::Row* row = rows[i];
    const auto t_ns = row ? time.of(*row) : std::nullopt;
    if (row && !t_ns && !names) {
      refuse({file, row->line}, "holds no time, and the rows do not name their pictures; give one");
    }
    if (t_ns) {
      frame.t_ns = *t_ns;
      timed.push_back(frame);
    } else {
      recorded.tally.add("pictures have no time in the table and are left out", frame.name());
    }
  }
  recorded.frames = std::move(timed);
  put_in_order(recorded.frames, file, recorded.tally);
  recorded.timed = true;
  recorded.has_own_clock = false;
}

}  // namespace lcs::replay
