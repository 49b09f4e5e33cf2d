// EuRoC ASL: pictures, IMU and truth under mav0/. The body frame is the IMU, as in EuRoC's own
// sequences: T_BS of imu0 and of the truth is the identity.
#include <fmt/format.h>

#include "tools/sequence/png.h"
#include "tools/sequence/pose_text.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

constexpr const char* kImuHeader =
    "#timestamp [ns],w_RS_S_x [rad s^-1],w_RS_S_y [rad s^-1],w_RS_S_z [rad s^-1],"
    "a_RS_S_x [m s^-2],a_RS_S_y [m s^-2],a_RS_S_z [m s^-2]\n";
constexpr const char* kTruthHeader =
    "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w [], q_RS_x [], q_RS_y [], q_RS_z "
    "[], v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], b_w_RS_S_x [rad s^-1], "
    "b_w_RS_S_y [rad s^-1], b_w_RS_S_z [rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], "
    "b_a_RS_S_z [m s^-2]\n";
constexpr const char* kPoseHeader =
    "#timestamp [ns],R_00,R_01,R_02,p_x [m],R_10,R_11,R_12,p_y [m],R_20,R_21,R_22,p_z [m]\n";
constexpr const char* kOdometryHeader =
    "#timestamp [ns],v_RB_B_x [m s^-1],v_RB_B_y [m s^-1],v_RB_B_z [m s^-1],"
    "w_RB_B_z [rad s^-1]\n";

std::string three(const Eigen::Vector3d& v) {
  return numbers({v.data(), 3}, ",");
}

/// The common beginning of each sensor.yaml.
std::string sensor_yaml(const char* type, const std::string& comment, const sim::Pose& T_BS) {
  return fmt::format(
      "sensor_type: {}\ncomment: {}\n\n# Sensor extrinsics wrt. the body frame: T_BS takes the "
      "sensor's coordinates to the body's.\nT_BS:\n  cols: 4\n  rows: 4\n  data: [{}]\n",
      type, comment, numbers(matrix_of(T_BS), ", "));
}

std::string imu_yaml(const SequenceInfo& info) {
  const scenario::Imu& imu = info.scenario.imu;
  return sensor_yaml("imu", fmt::format("simulated, preset {}", imu.preset), sim::Pose{}) +
         fmt::format(
             "rate_hz: {}\n\n# {}.\n\n# Noise: Kalibr's model.\n"
             "gyroscope_noise_density: {}      # [ rad / s / sqrt(Hz) ]\n"
             "gyroscope_random_walk: {}        # [ rad / s^2 / sqrt(Hz) ]\n"
             "accelerometer_noise_density: {}  # [ m / s^2 / sqrt(Hz) ]\n"
             "accelerometer_random_walk: {}    # [ m / s^3 / sqrt(Hz) ]\n",
             imu.rate_hz, reading_text(imu), imu.noise.gyroscope_noise_density,
             imu.noise.gyroscope_random_walk, imu.noise.accelerometer_noise_density,
             imu.noise.accelerometer_random_walk);
}

std::string camera_yaml(const SequenceInfo& info) {
  const sim::Lens& lens = info.calibration.optics.lens();
  const bool is_fisheye = lens.distortion == sim::Lens::Distortion::equidistant;
  const sim::Pose T_SC = info.calibration.T_BS.inverse() * info.calibration.T_BC;
  return sensor_yaml("camera", "simulated; x right, y down, z forward", T_SC) +
         fmt::format(
             "\n# Pixels: (0, 0) is the centre of the top-left one.\nrate_hz: {}\nresolution: "
             "[{}, {}]\ncamera_model: pinhole\nintrinsics: [{}, {}, {}, {}]  # fu, fv, cu, cv\n"
             "distortion_model: {}\ndistortion_coefficients: [{}]\n",
             info.scenario.camera.rate_hz, lens.width_px, lens.height_px, lens.fu_px, lens.fv_px,
             lens.cu_px, lens.cv_px, is_fisheye ? "equidistant" : "radial-tangential",
             lens.coefficients.empty() ? "0.0, 0.0, 0.0, 0.0"
                                       : numbers(four_coefficients(lens), ", "));
}

std::string odometry_yaml(const SequenceInfo& info) {
  const scenario::Odometry& odometry = info.scenario.odometry;
  return sensor_yaml("odometry",
                     "velocity of the rover's origin, in the rover's frame (x ahead, y left, z "
                     "up), and its yaw rate, by its wheels",
                     info.calibration.T_BS.inverse()) +
         fmt::format(
             "rate_hz: {}\nnoise_mps: {}     # white, standard deviation of a reading\n"
             "yaw_noise_radps: {}  # likewise\n"
             "scale_error: {}  # standard deviation of a scale drawn once\n",
             odometry.rate_hz, odometry.noise_mps, odometry.yaw_noise_radps, odometry.scale_error);
}

std::vector<SequenceDocument> euroc_documents(const SequenceInfo& info) {
  const auto csv = [](const std::string& path, const char* header, const char* stream) {
    return SequenceDocument{path, {{.text = header}, {.stream = stream}}};
  };
  const std::string camera = "mav0/" + camera_name(info.place);
  std::vector<SequenceDocument> all{csv(camera + "/pose.csv", kPoseHeader, "camera_pose"),
                                    {camera + "/sensor.yaml", {{.text = camera_yaml(info)}}}};
  if (!info.is_first()) return all;
  SequenceDocument truth =
      csv("mav0/state_groundtruth_estimate0/data.csv", kTruthHeader, "imu_truth");
  truth.parts.back().poses_between = ',';
  all.insert(all.end(),
             {csv("mav0/imu0/data.csv", kImuHeader, "imu"),
              truth,
              {"mav0/imu0/sensor.yaml", {{.text = imu_yaml(info)}}},
              {"mav0/state_groundtruth_estimate0/sensor.yaml",
               {{.text = sensor_yaml("visual-inertial",
                                     "pose, velocity and biases of the IMU, exact, at its readings",
                                     sim::Pose{})}}}});
  if (info.scenario.odometry.enabled) {
    all.push_back(csv("mav0/odometry0/data.csv", kOdometryHeader, "odometry"));
    all.push_back({"mav0/odometry0/sensor.yaml", {{.text = odometry_yaml(info)}}});
  }
  return all;
}

}  // namespace

std::string camera_name(std::size_t place) {
  return fmt::format("cam{}", place);
}

std::string picture_path(std::int64_t stamp_ns, std::size_t place) {
  return fmt::format("mav0/{}/data/{}.png", camera_name(place), stamp_ns);
}

/// Writes the pictures and their list, which every sequence has, and their exposures if these
/// change.
Writer picture_writer(const SequenceInfo& info) {
  const std::string folder = "mav0/" + camera_name(info.place);
  std::vector<SequenceDocument> documents{
      {folder + "/data.csv", {{.text = "#timestamp [ns],filename\n"}, {.stream = "pictures"}}}};
  if (info.scenario.image.auto_exposure) {
    documents.push_back(
        {folder + "/exposure.csv",
         {{.text = "#timestamp [ns],exposure [s],gain []\n"}, {.stream = "exposures"}}});
  }
  const auto write = [info](const FrameView& frame, FrameOutput& output) {
    const std::string path = picture_path(frame.stamp_ns, info.place);
    output.files.push_back({path, encode_png(frame.now.image, PngFilter::up), ""});
    output.rows["pictures"] = fmt::format("{0},{0}.png\n", frame.stamp_ns);
    const sim::Exposure& exposure = frame.now.exposure;
    output.rows["exposures"] =
        fmt::format("{},{},{}\n", frame.stamp_ns, exposure.time_s, exposure.gain);
  };
  return {write, documents};
}

Writer euroc_writer(const SequenceInfo& info) {
  const auto write = [info](const FrameView& frame, FrameOutput& output) {
    const sim::Observation& o = frame.now;
    const std::array<double, 16> T_WC = matrix_of(o.truth.now.T_WC);
    output.rows["camera_pose"] =
        fmt::format("{},{}\n", frame.stamp_ns, numbers(std::span(T_WC).first(12), ","));
    if (!info.is_first()) return;
    std::string& imu = output.rows["imu"];
    for (const sim::ImuSample& sample : o.imu) {
      imu += fmt::format("{},{},{}\n", kEpoch_ns + sample.t_ns, three(sample.gyro_radps),
                         three(sample.accel_mps2));
    }
    std::string& truth = output.rows["imu_truth"];
    for (const sim::ImuTruth& state : o.imu_truth) {
      const Eigen::Quaterniond q = quaternion_of(state.T_WS);
      truth += fmt::format("{},{},{},{},{},{},{},{},{}\n", kEpoch_ns + state.t_ns,
                           three(state.T_WS.p), q.w(), q.x(), q.y(), q.z(), three(state.v_WS_mps),
                           three(state.gyro_bias_radps), three(state.accel_bias_mps2));
    }
    std::string& odometry = output.rows["odometry"];
    for (const sim::OdometrySample& sample : o.odometry) {
      odometry += fmt::format("{},{},{}\n", kEpoch_ns + sample.t_ns, three(sample.velocity_mps),
                              sample.yaw_rate_radps.value());
    }
  };
  return {write, euroc_documents(info)};
}

}  // namespace lcs::sequence
