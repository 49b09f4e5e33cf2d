// TUM RGB-D: rgb.txt lists pictures with their times, groundtruth.txt the poses of the colour
// camera in a world frame with z up. A recording has no calibration.
#include "tools/replay/in_order.h"
#include "tools/replay/poses_file.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPictures = "rgb.txt";
constexpr const char* kTruth = "groundtruth.txt";

void read_motion(const scenario::Recorded& asked, const fs::path& file, Recorded& recorded) {
  const PosesFile file_poses = read_poses(file, asked.time_unit, recorded.tally);
  if (!file_poses.timed) {
    throw input::Error({file.string(), 0},
                       "its poses have no times; give them as TUM has them, or poses of your own");
  }
  std::vector<PosesMotion::CameraPose> poses;
  for (const auto& line : file_poses.lines) {
    if (line) poses.push_back({line->t_ns.value(), line->T_WC});
  }
  sort_by_time(poses, "poses", file.string(), recorded.tally);
  const auto up_W = up_of_world(asked, poses.front().T_WC, Eigen::Vector3d(0, 0, 1));
  auto motion = std::make_unique<PosesMotion>(std::move(poses), up_W);
  keep_within(motion->first_ns(), motion->last_ns(),
              "pictures are outside of the poses' time and are left out", recorded);
  recorded.motion = std::move(motion);
}

}  // namespace

bool is_tum_rgbd(const fs::path& folder) {
  return fs::exists(folder / kPictures);
}

Recorded read_tum_rgbd(const scenario::Recorded& asked, bool) {
  Recorded recorded;
  const TextTable list = read_table(asked.path / kPictures);
  for (const TextTable::Row& row : list.rows) {
    const auto t_ns = time_in(row.fields.front(), kSecond_ns);
    if (!t_ns || row.fields.size() < 2) {
      recorded.tally.add("rows cannot be read and are left out", list.at(row));
      continue;
    }
    const auto place = static_cast<std::size_t>(&row - list.rows.data());
    recorded.frames.push_back({*t_ns, asked.path / row.fields[1], place});
  }
  put_in_order(recorded.frames, list.file, recorded.tally);
  if (!motion_is_asked(asked) && fs::exists(asked.path / kTruth)) {
    read_motion(asked, asked.path / kTruth, recorded);
  }
  return recorded;
}

}  // namespace lcs::replay
