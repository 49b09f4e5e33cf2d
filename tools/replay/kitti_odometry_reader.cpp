// KITTI odometry: image_0/ to image_3/, calib.txt, times.txt and, for some sequences, poses of
// camera 0, beside the pictures or, as in the benchmark, in poses/NN.txt for sequences/NN/.
#include <fmt/format.h>

#include <algorithm>

#include "tools/replay/kitti_calibration.h"
#include "tools/replay/poses_file.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

constexpr const char* kOdometryCameras[] = {"image_0", "image_2", "image_1", "image_3"};
constexpr std::string_view kPrefix = "image_";

void read_times(const fs::path& file, Recorded& recorded) {
  const TextTable table = read_table(file);
  const auto rows = take_rows(file, table.rows.size(), "time", recorded);
  std::size_t next = 0;
  std::erase_if(recorded.frames, [&](RecordedFrame& frame) {
    const TextTable::Row& row = table.rows[rows[next++]];
    const auto t_ns = time_in(row.fields.front(), kSecond_ns);
    if (!t_ns) recorded.tally.add("rows cannot be read and are left out", table.at(row));
    frame.t_ns = t_ns.value_or(0);
    return !t_ns;
  });
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

/// The poses are of camera 0; y of their world frame points down.
void read_motion(const scenario::RecordingSource& asked, const fs::path& file,
                 const sim::Pose& T_C0C, Recorded& recorded) {
  const PosesFile poses = read_poses(file, asked.time_unit, recorded.tally);
  std::vector<PosesMotion::CameraPose> at_frames;
  const auto rows = take_rows(file, poses.lines.size(), "pose", recorded);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const auto& line = poses.lines[rows[i]];
    if (line) at_frames.push_back({recorded.frames[i].t_ns, line->T_WC * T_C0C});
  }
  move_along(std::move(at_frames), Vector3d(0, -1, 0), asked, file,
             "pictures have no pose and are left out", recorded);
}

}  // namespace

bool is_kitti_odometry(const fs::path& folder) {
  const bool any = std::ranges::any_of(
      kOdometryCameras, [&](const char* name) { return fs::is_directory(folder / name); });
  return any && fs::exists(folder / "calib.txt");
}

Recorded read_kitti_odometry(const scenario::RecordingSource& asked, bool) {
  const std::string camera = kitti_camera(asked, kOdometryCameras, "");
  if (!camera.starts_with(kPrefix) || !fs::is_directory(asked.path / camera)) {
    throw input::Error(asked.source, "{} is not there; name a camera, as image_0",
                       (asked.path / camera).string());
  }
  Recorded recorded;
  take_pictures(asked.path / camera, "", recorded);
  recorded.numbers.first = 0;
  recorded.timed = fs::exists(asked.path / "times.txt");
  if (recorded.timed) read_times(asked.path / "times.txt", recorded);
  const std::string projection = fmt::format("P{}", camera.substr(kPrefix.size()));
  const KittiCalibration calibration(asked.path / "calib.txt");
  recorded.lens = calibration.lens(projection);
  const fs::path poses = poses_of(asked.path);
  if (motion_is_asked(asked) || poses.empty()) return recorded;
  // Without times and a rate it will be rejected later, for that reason.
  if (!recorded.timed) time_by(asked.fps.value_or(1), recorded);
  read_motion(asked, poses, calibration.beside(projection).inverse(), recorded);
  return recorded;
}

}  // namespace lcs::replay
