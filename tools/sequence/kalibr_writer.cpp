// Kalibr's YAML: the camera with its pose on the IMU, and the noise of the IMU.
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
        "  rostopic: /cam0/image_raw\n  T_cam_imu:\n{}  timeshift_cam_imu: 0.0\n",
        numbers(coefficients, ", "),
        coefficients.size() > 4 ? "  # the fifth is k3, which Kalibr lacks" : "",
        lens.distortion == sim::Lens::Distortion::equidistant ? "equidistant" : "radtan",
        lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px, lens.width_px, lens.height_px, rows);
  }

  std::string imu() const {
    const scenario::ImuNoise& noise = info_.scenario.imu.noise;
    return fmt::format(
        "accelerometer_noise_density: {}\naccelerometer_random_walk: {}\n"
        "gyroscope_noise_density: {}\ngyroscope_random_walk: {}\n"
        "rostopic: /imu0\nupdate_rate: {}\n",
        noise.accelerometer_noise_density, noise.accelerometer_random_walk,
        noise.gyroscope_noise_density, noise.gyroscope_random_walk, info_.scenario.imu.rate_hz);
  }

  SequenceInfo info_;
};

}  // namespace

std::unique_ptr<Writer> make_kalibr_writer(const SequenceInfo& info) {
  return std::make_unique<KalibrWriter>(info);
}

}  // namespace lcs::sequence
