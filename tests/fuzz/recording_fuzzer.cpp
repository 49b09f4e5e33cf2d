// A recording of any layout but video, with poses or an IMU: it is read and the motion is estimated
// for every picture, or it is refused by an error. An input holds the files of the recording, each
// after a line "=== NAME".
#include <stdexcept>

#include "tests/fuzz/input.h"
#include "tools/replay/recorded.h"

namespace {

using namespace lcs;
namespace fs = std::filesystem;

/// Maximum number of pictures with motion: the time grows with their number.
constexpr std::size_t kMostFrames = 200;

/// The files that the readers open.
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
    "calib.txt",
    "times.txt",
    "poses.txt",
    "image_0/000000.png",
    "image_0/000001.png",
    "image_02/data/0000000000.jpg",
    "image_02/data/0000000001.jpg",
    "rgb.txt",
    "groundtruth.txt",
    "seqinfo.ini",
    "img1/000001.jpg",
    "img1/000002.jpg",
    "0.png",
    "1.png",
    "mav0/mocap0/data.csv",
    "mav0/cam0/data/1403636579763555584.png",
    "image_02/0000/000000.png",
    "image_02/0000/000001.png",
    "calib/0000.txt",
    "oxts/0000.txt",
    "image_00/timestamps.txt",
    "image_00/data_rect/0000000000.png",
    "images.txt",
    "images/00000.jpg",
    "images/00001.jpg",
    "asked_times.csv",
    "asked_calibration.yaml",
    "asked_imu_calibration.yaml",
    "asked_poses.txt",
    "asked_imu.csv",
    "asked_odometry.csv",
};

/// The user's scenario: from the existing files and the bits of a byte.
scenario::Scenario asked(const fs::path& folder, std::uint8_t bits) {
  scenario::Scenario scenario;
  if (bits & 1) scenario.ego_motion = scenario::EgoMotionSource::truth;
  scenario::RecordingSource& recording = scenario.recording.emplace();
  recording.source = {"asked", 1};
  recording.path = folder;
  if (bits & 2) recording.fps = 10;
  if (bits & 4) recording.focal_px = Eigen::Vector2d(300, 300);
  if (bits & 8) recording.mount_rpy_rad = Eigen::Vector3d(0, 0.1, 0);
  if (bits & 16) recording.every = 2;
  const auto file = [&](const char* name) {
    return fs::exists(folder / name) ? std::optional(folder / name) : std::nullopt;
  };
  recording.poses = file("asked_poses.txt");
  if (!recording.poses) recording.imu = file("asked_imu.csv");
  if (recording.imu) recording.odometry = file("asked_odometry.csv");
  recording.times = file("asked_times.csv");
  recording.calibration = file("asked_calibration.yaml");
  recording.imu_calibration = file("asked_imu_calibration.yaml");
  if (bits & 32) recording.time_unit = "ms";
  if (bits & 128 && !recording.poses) recording.speed_mps = 1;
  return scenario;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const fs::path folder = fuzz::work_folder() / "recording";
  // The first byte selects the user's options.
  const std::uint8_t options = size > 0 ? data[0] : 0;
  fuzz::write_sections(folder, kFiles, fuzz::text_of(data, size));
  try {
    replay::Recorded recorded = replay::read_recorded(asked(folder, options));
    fuzz::require(!recorded.frames.empty() && recorded.motion, "what is read has frames");
    for (std::size_t i = 0; i < recorded.frames.size() && i < kMostFrames; ++i) {
      if (i > 0) {
        fuzz::require(recorded.frames[i - 1].t_ns < recorded.frames[i].t_ns,
                      "frames are in the order of time");
      }
      const EgoMotion motion = recorded.motion->at(recorded.frames[i].t_ns);
      fuzz::require(motion.dt_s >= 0 || i > 0, "the first frame is not before itself");
      if (const auto up_C = recorded.motion->up_C()) {
        fuzz::require(std::abs(up_C->norm() - 1) < 1e-3, "up is a direction");
      }
    }
    for (const std::string& line : recorded.tally.lines()) {
      fuzz::require(!line.empty(), "what was wrong is told");
    }
  } catch (const std::runtime_error& error) {
    fuzz::require(std::string_view(error.what()).size() > 8, "an error says something");
  }
  return 0;
}
