// A recording of EuRoC, KITTI raw or RobotCar: it is read and its motion told for every picture, or
// it is refused by an error. An input holds the files of the recording, each behind a line "===
// NAME".
#include <stdexcept>

#include "tests/fuzz/input.h"
#include "tools/replay/recorded.h"

namespace {

using namespace lcs;
namespace fs = std::filesystem;

/// Pictures that are told the motion of, at the most: what it takes grows with their number.
constexpr std::size_t kMostFrames = 200;

/// The files that the readers look at.
constexpr const char* kFiles[] = {
    "mav0/cam0/data.csv",
    "mav0/cam0/sensor.yaml",
    "mav0/cam0/pose.csv",
    "mav0/imu0/data.csv",
    "mav0/imu0/sensor.yaml",
    "mav0/odometry0/data.csv",
    "mav0/state_groundtruth_estimate0/data.csv",
    "lcs.json",
    "image_02/timestamps.txt",
    "oxts/timestamps.txt",
    "oxts/data/0000000000.txt",
    "oxts/data/0000000001.txt",
    "oxts/data/0000000002.txt",
    "calib_cam_to_cam.txt",
    "calib_imu_to_velo.txt",
    "calib_velo_to_cam.txt",
    "stereo.timestamps",
    "gps/ins.csv",
    "stereo/centre/0.png",
};

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path folder = fuzz::work_folder() / "recording";
  // One byte first: what the user asks for.
  const std::uint8_t options = size > 0 ? data[0] : 0;
  fuzz::write_sections(folder, kFiles, fuzz::text_of(data, size));
  try {
    const replay::Layout& layout = replay::layout_of("auto", folder);
    replay::Recorded recorded = layout.read({.folder = folder, .exact_motion = (options & 1) != 0});
    fuzz::require(!recorded.frames.empty() && recorded.motion, "what is read has frames");
    for (std::size_t i = 0; i < recorded.frames.size() && i < kMostFrames; ++i) {
      if (i > 0) {
        fuzz::require(recorded.frames[i - 1].t_ns < recorded.frames[i].t_ns,
                      "frames are in the order of time");
      }
      const EgoMotion motion = recorded.motion->at(recorded.frames[i].t_ns);
      fuzz::require(motion.dt_s >= 0 || i > 0, "the first frame is not before itself");
    }
    for (const std::string& line : recorded.tally.lines()) {
      fuzz::require(!line.empty(), "what was wrong is told");
    }
  } catch (const std::runtime_error& error) {
    fuzz::require(std::string_view(error.what()).size() > 8, "an error says something");
  }
  return 0;
}
