// TUM RGB-D: rgb.txt lists pictures with their times, groundtruth.txt the poses of the colour
// camera in a world frame with z up. A recording has no calibration.
#include "tools/replay/recorded.h"
#include "tools/replay/text_table.h"
#include "tools/replay/times.h"

namespace lcs::replay {
namespace {

constexpr const char* kPictures = "rgb.txt";
constexpr const char* kTruth = "groundtruth.txt";

}  // namespace

bool is_tum_rgbd(const fs::path& folder) {
  return fs::exists(folder / kPictures);
}

Recorded read_tum_rgbd(const scenario::RecordingSource& asked, bool) {
  Recorded recorded;
  const auto picture = [&](const TextTable::Row& row) {
    return row.fields.size() > 1 ? asked.path / row.fields[1] : fs::path();
  };
  take_list(read_table(asked.path / kPictures), kSecond_ns, picture, recorded);
  if (!motion_is_asked(asked) && fs::exists(asked.path / kTruth)) {
    move_by_timed_poses(asked, asked.path / kTruth, Vector3d::UnitZ(), recorded);
  }
  return recorded;
}

}  // namespace lcs::replay
