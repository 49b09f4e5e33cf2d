// TUM RGB-D: rgb.txt lists pictures with their times, groundtruth.txt the poses of the colour
// camera in a world frame with z up. A recording has no calibration.
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

namespace fs = std::filesystem;

constexpr const char* kPictures = "rgb.txt";
constexpr const char* kTruth = "groundtruth.txt";

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
    move_by_timed_poses(asked, asked.path / kTruth, Eigen::Vector3d::UnitZ(), recorded);
  }
  return recorded;
}

}  // namespace lcs::replay
