// Events: the text files of RPG's event-camera dataset, and DSEC's HDF5, which write_events.py
// makes by h5py.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
namespace {

/// \throws input::Error if the scenario has no event pixels.
void require_events(const SequenceInfo& info, const char* format) {
  if (info.scenario.events) return;
  throw input::Error(
      {info.scenario.file.string(), 0},
      "the camera has no event pixels; add 'events: {{}}', or leave {} out of --formats", format);
}

}  // namespace

Writer rpg_writer(const SequenceInfo& info) {
  require_events(info, "events");
  const sim::Lens& lens = info.calibration.optics.lens();
  if (lens.distortion == sim::Lens::Distortion::equidistant) {
    throw input::Error(info.scenario.camera.source,
                       "the camera has an equidistant distortion, and RPG's calib.txt has none; "
                       "leave events out of --formats, or give another camera.distortion");
  }
  std::vector<double> calibration{lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px};
  std::ranges::copy(lens.coefficients, std::back_inserter(calibration));
  calibration.resize(9);
  std::vector<SequenceDocument> documents{
      {"rpg/calib.txt", {{.text = numbers(calibration, " ") + "\n"}}},
      {"rpg/images.txt", {{.stream = "rpg_images"}}},
      {"rpg/groundtruth.txt", {{.stream = "rpg_truth", .poses_between = ' '}}},
      {"rpg/events.txt", {{.stream = "rpg_events"}}}};
  if (info.is_first()) documents.push_back({"rpg/imu.txt", {{.stream = "rpg_imu"}}});
  const auto write = [info](const FrameView& frame, FrameOutput& output) {
    const std::string name = fmt::format("images/frame_{:08}.png", frame.now.index);
    output.files.push_back(
        {fmt::format("rpg/{}", name), "", picture_path(frame.stamp_ns, info.place)});
    output.rows["rpg_images"] = fmt::format("{} {}\n", seconds(frame.stamp_ns), name);
    output.rows["rpg_truth"] = pose_line(frame.stamp_ns, frame.now.truth.now.T_WC);
    std::string& events = output.rows["rpg_events"];
    for (const sim::Event& event : frame.now.events) {
      fmt::format_to(std::back_inserter(events), "{} {} {} {:d}\n",
                     seconds(info.stamp_ns(event.t_ns)), event.x, event.y, event.is_on);
    }
    if (!info.is_first()) return;
    std::string& imu = output.rows["rpg_imu"];
    for (const sim::ImuSample& sample : frame.now.imu) {
      const Eigen::Vector3d &a = sample.accel_mps2, &w = sample.gyro_radps;
      fmt::format_to(std::back_inserter(imu), "{} {} {} {} {} {} {}\n",
                     seconds(kEpoch_ns + sample.t_ns), a.x(), a.y(), a.z(), w.x(), w.y(), w.z());
    }
  };
  return {write, documents};
}

Writer dsec_writer(const SequenceInfo& info) {
  require_events(info, "dsec");
  constexpr double kMost_s = 1e-6 * std::numeric_limits<std::uint32_t>::max();
  const double duration_s = info.scenario.frames / info.scenario.camera.rate_hz;
  if (duration_s > kMost_s) {
    throw input::Error({info.scenario.file.string(), 0},
                       fmt::format("the sequence takes {:.0f} s, and DSEC's times in 32 bits end "
                                   "after {:.0f} s; give fewer frames, or leave dsec out of "
                                   "--formats",
                                   duration_s, kMost_s));
  }
  const auto write = [info](const FrameView& frame, FrameOutput& output) {
    std::string& events = output.rows["dsec"];
    for (const sim::Event& event : frame.now.events) {
      fmt::format_to(std::back_inserter(events), "{} {} {} {:d}\n", info.stamp_ns(event.t_ns),
                     event.x, event.y, event.is_on);
    }
  };
  return {write, {{kDsecFile, {{.stream = "dsec"}}}}};
}

}  // namespace lcs::sequence
