// Messages of all sensors for viewers. The rows are JSON, which write_bag.py turns into a bag of
// ROS 2 by PyPI's rosbags, and write_rrd.py into a recording of Rerun by PyPI's rerun-sdk.

#include <cmath>
#include <nlohmann/json.hpp>

#include "tools/files/json_node.h"
#include "tools/sequence/pose_text.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {

/// foxglove.json of this folder, a layout of Foxglove.
extern const std::string_view kFoxglove;

namespace {

nlohmann::json numbers_of(const Eigen::Vector3d& v) {
  return {v.x(), v.y(), v.z()};
}

/// x y z qx qy qz qw.
nlohmann::json pose_json(const sim::Pose& pose) {
  const Eigen::Quaterniond q = quaternion_of(pose);
  return {pose.p.x(), pose.p.y(), pose.p.z(), q.x(), q.y(), q.z(), q.w()};
}

/// A row that begins with a time.
nlohmann::json timed(std::int64_t t_ns, std::initializer_list<nlohmann::json> lists) {
  nlohmann::json row = {kEpoch_ns + t_ns};
  for (const nlohmann::json& list : lists) row.insert(row.end(), list.begin(), list.end());
  return row;
}

std::string frame_name(std::size_t place) {
  return camera_name(place) + "_optical";
}

nlohmann::json sensors(const SequenceInfo& info) {
  const scenario::Imu& imu = info.scenario.imu;
  const scenario::Odometry& wheels = info.scenario.odometry;
  const auto variance = [&](double density) { return density * density * imu.rate_hz; };
  const double v = std::pow(wheels.noise_mps, 2), yaw = std::pow(wheels.yaw_noise_radps, 2);
  nlohmann::json json{{"start", kEpoch_ns},
                      {"imu_variances",
                       {variance(imu.noise.gyroscope_noise_density),
                        variance(imu.noise.accelerometer_noise_density)}},
                      {"wheel_variances", {v, v, 0, 0, 0, yaw}}};
  const sim::Pose T_SB = info.calibration.T_BS.inverse();
  json["links"]["base"] = pose_json(T_SB);
  for (std::size_t i = 0; i < info.rig.size(); ++i) {
    const sim::Lens& lens = info.rig[i]->optics.lens();
    const bool is_fisheye = lens.distortion == sim::Lens::Distortion::equidistant;
    json["links"][frame_name(i)] = pose_json(T_SB * info.rig[i]->T_BC);
    json["cameras"].push_back(
        {{"frame", frame_name(i)},
         {"width", lens.width_px},
         {"height", lens.height_px},
         {"intrinsics", {lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px}},
         {"P_03", -lens.fu_px * between(*info.rig[0], *info.rig[i]).p.x()},
         {"model", is_fisheye ? "equidistant" : "plumb_bob"},
         {"distortion", lens.coefficients.empty() ? std::vector<double>(5) : lens.coefficients}});
  }
  return json;
}

/// \param format whose stream has the rows. \param file of its document.
Writer message_writer(const SequenceInfo& info, const std::string& format, const char* file) {
  const auto write = [info, format](const FrameView& frame, FrameOutput& output) {
    const sim::Observation& o = frame.now;
    nlohmann::json json{{"t", frame.stamp_ns},
                        {"place", info.place},
                        {"picture", picture_path(frame.stamp_ns, info.place)},
                        {"boxes", nlohmann::json::array()}};
    for (const sim::ObjectTruth& box : o.objects) {
      const sim::Object& object = info.objects.at(static_cast<std::size_t>(box.object - 1));
      json["boxes"].push_back({box.object, kind_of(info.scenario, object).category, box.left,
                               box.top, box.right, box.bottom});
    }
    if (info.is_first()) {
      for (const char* key : {"imu", "states", "wheels"}) json[key] = nlohmann::json::array();
      for (const sim::ImuSample& sample : o.imu) {
        json["imu"].push_back(
            timed(sample.t_ns, {numbers_of(sample.gyro_radps), numbers_of(sample.accel_mps2)}));
      }
      for (const sim::ImuTruth& state : o.imu_truth) {
        json["states"].push_back(timed(state.t_ns, {pose_json(state.T_WS)}));
      }
      for (const sim::OdometrySample& sample : o.odometry) {
        json["wheels"].push_back(timed(
            sample.t_ns,
            {numbers_of(sample.velocity_mps), nlohmann::json::array({*sample.yaw_rate_radps})}));
      }
      const sim::Pose& T_WC = o.truth.now.T_WC;
      json["truth"] = {{"t", kEpoch_ns + o.t_ns},  // by the clock of the IMU
                       {"T_WC", pose_json(T_WC)},
                       {"v_C", numbers_of(T_WC.R.transpose() * o.truth.v_WC_mps)},
                       {"w_C", numbers_of(o.truth.w_C_radps)}};
    }
    output.rows[format] = files::json_text(json) + "\n";
  };
  if (!info.is_first()) return {write};
  SequenceDocument messages{file, {{.text = files::json_text(sensors(info)) + "\n"}}};
  for (std::size_t place = 0; place < info.rig.size(); ++place) {
    const std::string of = place == 0 ? "" : camera_name(place) + "/";
    messages.parts.push_back({.stream = of + format});
  }
  return {write, {messages}};
}

}  // namespace

Writer mcap_writer(const SequenceInfo& info) {
  Writer writer = message_writer(info, "mcap", kBagFile);
  if (info.is_first())
    writer.documents.push_back({kLayoutFile, {{.text = std::string(kFoxglove)}}});
  return writer;
}

Writer rrd_writer(const SequenceInfo& info) {
  return message_writer(info, "rrd", kRerunFile);
}

}  // namespace lcs::sequence
