// Kalibr's YAML: the camera with its pose on the IMU and its time offset, and noise and errors of
// the IMU.
#include <fmt/format.h>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

class KalibrWriter : public Writer {
 public:
  explicit KalibrWriter(const SequenceInfo& info) : info_(info) {}

  void write(const FrameView&, FrameOutput&) const override {}

  std::vector<Document> documents() const override {
    return {{"kalibr/camchain.yaml", {{.text = camchain()}}},
            {"kalibr/imu.yaml", {{.text = imu()}}}};
  }

 private:
  std::string camchain() const {
    const sim::Lens& lens = info_.calibration.optics.lens();
    const std::vector<double> coefficients = four_coefficients(lens);
    const sim::Pose T_CS = info_.calibration.T_BC.inverse() * info_.calibration.T_BS;
    const std::array<double, 16> matrix = matrix_of(T_CS);
    std::string rows;
    for (std::size_t row = 0; row < 4; ++row) {
      rows += fmt::format("  - [{}]\n", numbers(std::span(matrix).subspan(4 * row, 4), ", "));
    }
    return fmt::format(
        "cam0:\n  cam_overlaps: []\n  camera_model: pinhole\n  distortion_coeffs: [{}]{}\n"
        "  distortion_model: {}\n  intrinsics: [{}, {}, {}, {}]\n  resolution: [{}, {}]\n"
        "  rostopic: /cam0/image_raw\n  T_cam_imu:\n{}  timeshift_cam_imu: {}\n{}",
        numbers(coefficients, ", "),
        coefficients.size() > 4 ? "  # the fifth is k3, which Kalibr lacks" : "",
        lens.distortion == sim::Lens::Distortion::equidistant ? "equidistant" : "radtan",
        lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px, lens.width_px, lens.height_px, rows,
        info_.calibration.time_offset_s == 0 ? "0.0"
                                             : fmt::format("{}", info_.calibration.time_offset_s),
        shutter());
  }

  std::string imu() const {
    const scenario::ImuNoise& noise = info_.scenario.imu.noise;
    return fmt::format(
        "accelerometer_noise_density: {}\naccelerometer_random_walk: {}\n"
        "gyroscope_noise_density: {}\ngyroscope_random_walk: {}\n"
        "rostopic: /imu0\nupdate_rate: {}\n{}",
        noise.accelerometer_noise_density, noise.accelerometer_random_walk,
        noise.gyroscope_noise_density, noise.gyroscope_random_walk, info_.scenario.imu.rate_hz,
        imu_errors());
  }

  /// Kalibr's camera-IMU calibration has no place for it.
  std::string shutter() const {
    const scenario::Camera& camera = info_.scenario.camera;
    if (camera.rolling_shutter_s == 0) return "";
    return fmt::format("  # rolling shutter: row y is {} s times y later than the first row\n",
                       camera.rolling_shutter_s / camera.height_px);
  }

  /// As Kalibr writes the result of its model "scale-misalignment".
  std::string imu_errors() const {
    const auto& [M, C_gyro_i, A, range_radps, resolution_radps] = info_.scenario.imu.gyroscopes;
    const scenario::Accelerometers& accelerometers = info_.scenario.imu.accelerometers;
    std::string text;
    if (info_.scenario.imu.gyroscopes != scenario::Gyroscopes{} ||
        accelerometers != scenario::Accelerometers{}) {
      const auto matrix = [](const char* name, const Eigen::Matrix3d& m) {
        std::string rows;
        for (int row = 0; row < 3; ++row) {
          rows += fmt::format("  - [{}, {}, {}]\n", m(row, 0), m(row, 1), m(row, 2));
        }
        return fmt::format("  {}:\n{}", name, rows);
      };
      text = "model: scale-misalignment\naccelerometers:\n" + matrix("M", accelerometers.M) +
             "gyroscopes:\n" + matrix("A", A) + matrix("C_gyro_i", C_gyro_i) + matrix("M", M);
    }
    const auto limit = [&](const char* what, const std::optional<double>& value, const char* unit) {
      if (value) text += fmt::format("# {}: {} {}; Kalibr has no key of it\n", what, *value, unit);
    };
    limit("range of the gyroscopes", range_radps, "rad/s");
    limit("resolution of the gyroscopes", resolution_radps, "rad/s");
    limit("range of the accelerometers", accelerometers.range_mps2, "m/s^2");
    limit("resolution of the accelerometers", accelerometers.resolution_mps2, "m/s^2");
    return text;
  }

  SequenceInfo info_;
};

}  // namespace

std::unique_ptr<Writer> make_kalibr_writer(const SequenceInfo& info) {
  return std::make_unique<KalibrWriter>(info);
}

}  // namespace lcs::sequence
