// A folder of pictures, with nothing but what the user knows of them.
#include <fmt/format.h>

#include <Eigen/Geometry>
#include <cmath>
#include <stdexcept>

#include "tools/bench/picture_folder.h"
#include "tools/replay/navigation.h"
#include "tools/replay/recorded.h"
#include "tools/replay/sensor_csv.h"

namespace lcs::replay {

bool is_pictures(const std::filesystem::path& folder) {
  try {
    return bench::PictureFolder(folder).size() > 0;
  } catch (const std::runtime_error&) {
    return false;
  }
}

Recorded read_pictures(const ReadOptions& options) {
  const bench::PictureFolder pictures(options.folder);
  if (!options.fps) {
    throw std::runtime_error("pictures do not say when they were taken; give --fps");
  }
  if (!options.speed_mps && !options.imu) {
    throw std::runtime_error("pictures do not say how the camera moved; give --speed or --imu");
  }
  Recorded recorded;
  for (std::size_t i = 0; i < pictures.size(); ++i) {
    const std::int64_t t_ns = std::llround(static_cast<double>(i) * 1e9 / *options.fps);
    recorded.frames.push_back({t_ns, pictures.file(i)});
  }
  if (!options.imu) {
    recorded.motion = std::make_unique<SteadyMotion>(*options.speed_mps);
    return recorded;
  }
  // The first picture is taken at the first reading; the IMU's axes are the rover's.
  SensorReadings readings;
  readings.imu = read_imu_csv(*options.imu, recorded.tally);
  const std::int64_t first_ns = readings.imu.front().t_ns;
  for (sim::ImuSample& sample : readings.imu) sample.t_ns -= first_ns;
  sim::Calibration calibration;
  calibration.T_BC.R = camera_mount(options.mount_rpy_rad.value_or(Eigen::Vector3d::Zero()));
  calibration.v_WB_start_mps =
      options.speed_mps.value_or(0) * calibration.T_BC.R.col(2);  // along the optical axis
  recorded.motion =
      std::make_unique<SensorMotion>(recorded.settings, calibration, std::move(readings));
  return recorded;
}

}  // namespace lcs::replay
