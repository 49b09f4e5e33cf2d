// TUM RGB-D: rgb.txt lists pictures with their times, groundtruth.txt the poses of the colour
// camera in a world frame with z up. A recording has no calibration.
// RPG's event-camera dataset (Mueggler et al., IJRR 2017): events.txt (t x y p), images.txt
// (t name), calib.txt (fx fy cx cy k1 k2 p1 p2 k3), groundtruth.txt (TUM's lines, of the camera),
// imu.txt (t ax ay az gx gy gz).
#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scenarios/input/input_file.h"
#include "tools/files/csv.h"
#include "tools/replay/calibration.h"
#include "tools/replay/recorded.h"
#include "tools/replay/sensor_csv.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

constexpr const char* kEvents = "events.txt";
constexpr const char* kPictureList = "images.txt";
constexpr const char* kTumPictureList = "rgb.txt";
constexpr const char* kTruth = "groundtruth.txt";

/// The first four fields between blanks.
std::array<std::string_view, 4> fields_in(std::string_view line) {
  std::array<std::string_view, 4> fields;
  for (std::string_view& field : fields) {
    line.remove_prefix(std::min(line.find_first_not_of(' '), line.size()));
    field = line.substr(0, line.find(' '));
    line.remove_prefix(field.size());
  }
  return fields;
}

std::vector<sim::Event> read_events(const fs::path& path, Tally& tally) {
  constexpr input::FileKind kKind{16 * input::kGibibyte, "give lines of t x y p"};
  input::InputFile file(path, kKind);
  std::vector<sim::Event> events;
  for (std::string line; file.next_line(line);) {
    const auto [time, column, row, polarity] = fields_in(files::trimmed(line));
    const auto t_ns = time_in(time, kSecond_ns);
    const auto x = files::number_in<std::uint16_t>(column);
    const auto y = files::number_in<std::uint16_t>(row);
    if (!t_ns || !x || !y || (polarity != "0" && polarity != "1")) {
      tally.add("events cannot be read and are left out",
                fmt::format("{}:{}", path.string(), file.here().line));
      continue;
    }
    if (!events.empty() && *t_ns < events.back().t_ns) {
      throw input::Error(file.here(),
                         "is earlier than the event before it; sort the lines by time");
    }
    events.push_back({*t_ns, *x, *y, polarity == "1"});
  }
  return events;
}

Lens read_lens(const fs::path& file) {
  const TextTable table = read_table(file);
  const auto numbers =
      table.rows.size() == 1 ? TextTable::numbers(table.rows[0], 0, 9) : std::nullopt;
  if (!numbers)
    throw input::Error({file.string(), 0}, "has not one line of fx fy cx cy k1 k2 p1 p2 k3");
  const std::vector<double>& n = *numbers;
  Lens lens = pinhole({n[0], n[1], n[2], n[3]}, {file.string(), 0});
  const std::vector<double> k(n.begin() + 4, n.end());
  if (std::ranges::any_of(k, [](double c) { return c != 0; })) {
    lens.distortion = Lens::Distortion::radial_tangential;
    lens.coefficients = k;
  }
  return lens;
}

}  // namespace

bool is_tum_rgbd(const fs::path& folder) {
  return fs::exists(folder / kTumPictureList);
}

Recorded read_tum_rgbd(const scenario::RecordingSource& asked, bool) {
  Recorded recorded;
  const auto picture = [&](const TextTable::Row& row) {
    return row.fields.size() > 1 ? asked.path / row.fields[1] : fs::path();
  };
  take_list(read_table(asked.path / kTumPictureList), kSecond_ns, picture, recorded);
  if (!motion_is_asked(asked) && fs::exists(asked.path / kTruth)) {
    move_by_timed_poses(asked, asked.path / kTruth, Vector3d::UnitZ(), recorded);
  }
  return recorded;
}

bool is_rpg_events(const fs::path& folder) {
  return fs::exists(folder / kEvents) && fs::exists(folder / kPictureList);
}

/// The layout does not state where the camera is on the IMU. The motion comes from the IMU if
/// `asked.calibration` states it, else from the truth.
Recorded read_rpg_events(const scenario::RecordingSource& asked, bool exact_motion) {
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
    const TableTimes in_seconds{"s", {kSlowestImu_hz, kFastestImu_hz, {}}, kSecond_ns};
    readings.imu = read_imu_csv(imu, in_seconds, recorded.tally, {4, 5, 6, 1, 2, 3});
    move_by_readings(asked, imu, std::move(readings), recorded);
  } else if (fs::exists(truth)) {
    recorded.took.insert("ego_motion: truth");
    move_by_timed_poses(asked, truth, Vector3d::UnitZ(), recorded);
  }
  return recorded;
}

}  // namespace lcs::replay
