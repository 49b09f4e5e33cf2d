// Kalibr's YAML: the camera with its pose on the IMU and its time offset, and noise and errors of
// the IMU.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

class KalibrWriter : public Writer {
 public:
  using Writer::Writer;

  std::vector<SequenceDocument> documents() const override {
    if (!info_.is_first()) return {};
    std::string camchain;
    for (std::size_t place = 0; place < info_.rig.size(); ++place) camchain += camera(place);
    return {{"kalibr/camchain.yaml", {{.text = camchain}}}, {"kalibr/imu.yaml", {{.text = imu()}}}};
  }

 private:
  /// \param values of a square matrix, row by row.
  static std::string rows(std::span<const double> values, std::size_t size) {
    std::string text;
    for (std::size_t row = 0; row < size; ++row) {
      text += fmt::format("  - [{}]\n", numbers(values.subspan(size * row, size), ", "));
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
        "  rostopic: /{}/image_raw\n  T_cam_imu:\n{}  timeshift_cam_imu: {}  # of the clocks; "
        "{}\n{}",
        camera_name(place),
        place == 0 ? ""
                   : "  T_cn_cnm1:\n" + rows(matrix_of(between(own, *info_.rig[place - 1])), 4),
        fmt::join(others, ", "), numbers(coefficients, ", "),
        coefficients.size() > 4 ? "  # the fifth is k3, which Kalibr lacks" : "",
        lens.distortion == sim::Lens::Distortion::equidistant ? "equidistant" : "radtan",
        lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px, lens.width_px, lens.height_px,
        camera_name(place), rows(matrix_of(own.T_BC.inverse() * own.T_BS), 4),
        own.time_offset_s == 0 ? "0.0" : fmt::format("{}", own.time_offset_s),
        reading_text(info_.scenario.imu), shutter(place));
  }

  std::string imu() const {
    const scenario::ImuNoise& noise = info_.scenario.imu.noise;
    return fmt::format(
        "accelerometer_noise_density: {}\naccelerometer_random_walk: {}\n"
        "gyroscope_noise_density: {}\ngyroscope_random_walk: {}\n"
        "rostopic: /imu0\nupdate_rate: {}\n# {}\n{}",
        noise.accelerometer_noise_density, noise.accelerometer_random_walk,
        noise.gyroscope_noise_density, noise.gyroscope_random_walk, info_.scenario.imu.rate_hz,
        reading_text(info_.scenario.imu), imu_errors());
  }

  /// Kalibr's camera-IMU calibration has no place for it.
  std::string shutter(std::size_t place) const {
    const scenario::Camera camera = scenario::seen_by(info_.scenario, place).camera;
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
        const Eigen::Matrix3d by_column = m.transpose();
        return fmt::format("  {}:\n{}", name, rows({by_column.data(), 9}, 3));
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
};

}  // namespace

const MakeWriter make_kalibr_writer = make_writer<KalibrWriter>;

}  // namespace lcs::sequence
