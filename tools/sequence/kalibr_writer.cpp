// Kalibr's YAML: the camera with its pose on the IMU, and the noise of the IMU.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

class KalibrWriter : public Writer {
 public:
  explicit KalibrWriter(const SequenceInfo& info) : info_(info) {}

  void write(const FrameView&, FrameOutput&) const override {}

  std::vector<Document> documents() const override {
    if (!info_.is_first()) return {};
    std::string camchain;
    for (std::size_t place = 0; place < info_.rig.size(); ++place) camchain += camera(place);
    return {{"kalibr/camchain.yaml", {{.text = camchain}}}, {"kalibr/imu.yaml", {{.text = imu()}}}};
  }

 private:
  static std::string rows(const sim::Pose& pose) {
    const std::array<double, 16> matrix = matrix_of(pose);
    std::string text;
    for (std::size_t row = 0; row < 4; ++row) {
      text += fmt::format("  - [{}]\n", numbers(std::span(matrix).subspan(4 * row, 4), ", "));
    }
    return text;
  }

  std::string camera(std::size_t place) const {
    const sim::Calibration& own = *info_.rig[place];
    const sim::Lens& lens = own.optics.lens();
    const std::vector<double> coefficients = four_coefficients(lens);
    std::vector<std::size_t> others;  // views are taken to overlap
    for (std::size_t i = 0; i < info_.rig.size(); ++i) {
      if (i != place) others.push_back(i);
    }
    return fmt::format(
        "{}:\n{}  cam_overlaps: [{}]\n  camera_model: pinhole\n  distortion_coeffs: [{}]{}\n"
        "  distortion_model: {}\n  intrinsics: [{}, {}, {}, {}]\n  resolution: [{}, {}]\n"
        "  rostopic: /{}/image_raw\n  T_cam_imu:\n{}  timeshift_cam_imu: 0.0\n",
        camera_name(place),
        place == 0 ? "" : "  T_cn_cnm1:\n" + rows(between(own, *info_.rig[place - 1])),
        fmt::join(others, ", "), numbers(coefficients, ", "),
        coefficients.size() > 4 ? "  # the fifth is k3, which Kalibr lacks" : "",
        lens.distortion == sim::Lens::Distortion::equidistant ? "equidistant" : "radtan",
        lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px, lens.width_px, lens.height_px,
        camera_name(place), rows(own.T_BC.inverse() * own.T_BS));
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
