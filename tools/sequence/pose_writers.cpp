// Poses and calibrations as text: TUM, Kalibr and KITTI odometry.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <stdexcept>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

/// \param values of a square matrix, row by row.
std::string rows(std::span<const double> values, std::size_t size) {
  std::string text;
  for (std::size_t row = 0; row < size; ++row) {
    text += fmt::format("  - [{}]\n", numbers(values.subspan(size * row, size), ", "));
  }
  return text;
}

/// Kalibr's camera-IMU calibration has no place for it.
std::string shutter(const SequenceInfo& info, std::size_t place) {
  const scenario::Camera camera = scenario::seen_by(info.scenario, place).camera;
  if (camera.rolling_shutter_s == 0) return "";
  return fmt::format("  # rolling shutter: row y is {} s times y later than the first row\n",
                     camera.rolling_shutter_s / camera.height_px);
}

std::string kalibr_camera(const SequenceInfo& info, std::size_t place) {
  const sim::Calibration& own = *info.rig[place];
  const sim::Lens& lens = own.optics.lens();
  const std::vector<double> coefficients = four_coefficients(lens);
  std::vector<std::size_t> others;  // views are taken to overlap
  for (std::size_t i = 0; i < info.rig.size(); ++i) {
    if (i != place) others.push_back(i);
  }
  return fmt::format(
      "{}:\n{}  cam_overlaps: [{}]\n  camera_model: pinhole\n  distortion_coeffs: [{}]{}\n"
      "  distortion_model: {}\n  intrinsics: [{}, {}, {}, {}]\n  resolution: [{}, {}]\n"
      "  rostopic: /{}/image_raw\n  T_cam_imu:\n{}  timeshift_cam_imu: {}  # of the clocks; "
      "{}\n{}",
      camera_name(place),
      place == 0 ? "" : "  T_cn_cnm1:\n" + rows(matrix_of(between(own, *info.rig[place - 1])), 4),
      fmt::join(others, ", "), numbers(coefficients, ", "),
      coefficients.size() > 4 ? "  # the fifth is k3, which Kalibr lacks" : "",
      lens.distortion == sim::Lens::Distortion::equidistant ? "equidistant" : "radtan", lens.fu_px,
      lens.fv_px, lens.cu_px, lens.cv_px, lens.width_px, lens.height_px, camera_name(place),
      rows(matrix_of(own.T_BC.inverse() * own.T_BS), 4),
      own.time_offset_s == 0 ? "0.0" : fmt::format("{}", own.time_offset_s),
      reading_text(info.scenario.imu), shutter(info, place));
}

/// As Kalibr writes the result of its model "scale-misalignment".
std::string imu_errors(const scenario::Imu& imu) {
  const auto& [M, C_gyro_i, A, range_radps, resolution_radps] = imu.gyroscopes;
  const scenario::Accelerometers& accelerometers = imu.accelerometers;
  std::string text;
  if (imu.gyroscopes != scenario::Gyroscopes{} || accelerometers != scenario::Accelerometers{}) {
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

std::string kalibr_imu(const scenario::Imu& imu) {
  const scenario::ImuNoise& noise = imu.noise;
  return fmt::format(
      "accelerometer_noise_density: {}\naccelerometer_random_walk: {}\n"
      "gyroscope_noise_density: {}\ngyroscope_random_walk: {}\n"
      "rostopic: /imu0\nupdate_rate: {}\n# {}\n{}",
      noise.accelerometer_noise_density, noise.accelerometer_random_walk,
      noise.gyroscope_noise_density, noise.gyroscope_random_walk, imu.rate_hz, reading_text(imu),
      imu_errors(imu));
}

/// \throws input::Error unless a projection P describes each camera: no distortion, and all
/// cameras side by side along x with one matrix of intrinsics.
void require_rectified(const SequenceInfo& info) {
  constexpr double kRounding = 1e-9;
  const auto require = [&](bool holds, const char* fault, const char* remedy) {
    if (holds) return;
    throw input::Error(
        info.scenario.camera.source,
        "{}, and KITTI's calib.txt is of rectified cameras; leave kitti out of --formats, or {}",
        fault, remedy);
  };
  const sim::Lens& lens = info.calibration.optics.lens();
  const sim::Lens& first = info.rig[0]->optics.lens();
  const sim::Pose T_0 = between(*info.rig[0], info.calibration);
  require(lens.distortion == sim::Lens::Distortion::none, "the camera has a distortion",
          "remove camera.distortion");
  require(T_0.R.isIdentity(kRounding) && T_0.p.tail<2>().norm() < kRounding,
          "the cameras are not parallel and side by side",
          "give them one rotation, and places that differ along their x alone");
  require(lens.fu_px == first.fu_px && lens.fv_px == first.fv_px && lens.cu_px == first.cu_px &&
              lens.cv_px == first.cv_px && lens.width_px == first.width_px &&
              lens.height_px == first.height_px,
          "the cameras have different intrinsics", "give them one focal length, centre and size");
}

}  // namespace

/// Trajectories in the format of TUM's RGB-D benchmark: t x y z qx qy qz qw.
Writer tum_writer(const SequenceInfo& info) {
  std::vector<SequenceDocument> documents{
      {"tum/camera.txt", {{.stream = "tum_camera", .poses_between = ' '}}}};
  if (info.is_first())
    documents.push_back({"tum/imu.txt", {{.stream = "tum_imu", .poses_between = ' '}}});
  const auto write = [info](const FrameView& frame, FrameOutput& output) {
    output.rows["tum_camera"] = pose_line(frame.stamp_ns, frame.now.truth.now.T_WC);
    if (!info.is_first()) return;
    std::string& imu = output.rows["tum_imu"];
    for (const sim::ImuTruth& state : frame.now.imu_truth)
      imu += pose_line(kEpoch_ns + state.t_ns, state.T_WS);
  };
  return {write, documents};
}

/// Kalibr's YAML: the camera with its pose on the IMU and its time offset, and noise and errors of
/// the IMU.
Writer kalibr_writer(const SequenceInfo& info) {
  if (!info.is_first()) return {};
  std::string camchain;
  for (std::size_t place = 0; place < info.rig.size(); ++place) {
    camchain += kalibr_camera(info, place);
  }
  return {.documents = {{"kalibr/camchain.yaml", {{.text = camchain}}},
                        {"kalibr/imu.yaml", {{.text = kalibr_imu(info.scenario.imu)}}}}};
}

/// KITTI odometry's layout: rectified cameras by their projections, times and poses.
Writer kitti_writer(const SequenceInfo& info) {
  require_rectified(info);
  const auto write = [info](const FrameView& frame, FrameOutput& output) {
    output.files.push_back({fmt::format("kitti/image_{}/{:06}.png", info.place, frame.now.index),
                            "", picture_path(frame.stamp_ns, info.place)});
    if (!info.is_first()) return;
    output.rows["kitti_times"] =
        fmt::format("{:.9f}\n", 1e-9 * static_cast<double>(frame.stamp_ns - kEpoch_ns));
    const std::array<double, 16> T_WC = matrix_of(frame.now.truth.now.T_WC);
    output.rows["kitti_poses"] = numbers(std::span(T_WC).first(12), " ") + "\n";
  };
  if (!info.is_first()) return {write};
  std::string calibration;
  for (std::size_t i = 0; i < info.rig.size(); ++i) {
    const sim::Lens& lens = info.rig[i]->optics.lens();
    const double along_x_m = between(*info.rig[0], *info.rig[i]).p.x();
    const double base = along_x_m == 0 ? 0 : -lens.fu_px * along_x_m;  // no -0
    const std::array<double, 12> P{lens.fu_px, 0, lens.cu_px, base, 0, lens.fv_px,
                                   lens.cv_px, 0, 0,          0,    1, 0};
    calibration += fmt::format("P{}: {}\n", i, numbers(P, " "));
  }
  return {write,
          {{"kitti/calib.txt", {{.text = calibration}}},
           {"kitti/times.txt", {{.stream = "kitti_times"}}},
           {"kitti/poses.txt", {{.stream = "kitti_poses"}}}}};
}

using RowByRow = Eigen::Matrix<double, 4, 4, Eigen::RowMajor>;

/// A loop, because GCC 13 warns within fmt 9 about `fmt::join` of numbers.
std::string numbers(std::span<const double> values, const char* separator) {
  std::string text;
  for (const double value : values) {
    text += fmt::format("{}{}", text.empty() ? "" : separator, value);
  }
  return text;
}

std::string seconds(std::int64_t t_ns) {
  constexpr std::int64_t kSecond_ns = 1'000'000'000;
  return fmt::format("{}.{:09}", t_ns / kSecond_ns, t_ns % kSecond_ns);
}

std::string pose_line(std::int64_t t_ns, const sim::Pose& pose) {
  const Eigen::Quaterniond q = quaternion_of(pose);
  return fmt::format("{} {} {} {} {} {} {} {}\n", seconds(t_ns), pose.p.x(), pose.p.y(), pose.p.z(),
                     q.x(), q.y(), q.z(), q.w());
}

std::string reading_text(const scenario::Imu& imu) {
  if (imu.reading == scenario::ImuReading::sample) {
    return "a reading is the sample of the instant of its stamp (imu.reading: sample)";
  }
  return fmt::format(
      "a reading is the mean over the {} ms before its stamp (imu.reading: mean): exact for tools "
      "that integrate it over this time; tools that take it for a sample of its stamp see the "
      "motion {} ms late",
      1000 / imu.rate_hz, 500 / imu.rate_hz);
}

std::vector<double> four_coefficients(const sim::Lens& lens) {
  std::vector<double> coefficients = lens.coefficients;
  if (coefficients.empty() || (coefficients.size() == 5 && coefficients[4] == 0)) {
    coefficients.resize(4);
  }
  return coefficients;
}

Eigen::Quaterniond quaternion_of(const sim::Pose& pose) {
  Eigen::Quaterniond q(pose.R);
  q.normalize();
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  return q;
}

std::array<double, 16> matrix_of(const sim::Pose& pose) {
  std::array<double, 16> matrix{};
  Eigen::Map<RowByRow>(matrix.data()) << pose.R, pose.p, Eigen::RowVector4d::UnitW();
  return matrix;
}

sim::Pose pose_of(const std::array<double, 16>& matrix) {
  constexpr double kTolerance = 1e-6;  // calibration matrices are printed with 7 digits or more
  const Eigen::Map<const RowByRow> all(matrix.data());
  const sim::Pose pose{all.topLeftCorner<3, 3>(), all.topRightCorner<3, 1>()};
  const bool is_rotation = (pose.R * pose.R.transpose()).isIdentity(kTolerance) &&
                           pose.R.determinant() > 0 && pose.p.allFinite();
  if (!is_rotation || all.row(3) != Eigen::RowVector4d::UnitW()) {
    throw std::invalid_argument("is not a rigid transform (a rotation, a translation, 0 0 0 1)");
  }
  return pose;
}

}  // namespace lcs::sequence
