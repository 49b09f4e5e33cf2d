// Events: the text files of RPG's event-camera dataset, and DSEC's HDF5, which write_events.py
// makes by h5py.
#include <fmt/format.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <limits>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/writers.h"

namespace lcs::sequence {
namespace {

/// \throws input::Error if the scenario has no event pixels.
void require_events(const SequenceInfo& info, const char* format) {
  if (info.scenario.events) return;
  throw input::Error(
      {info.scenario.file.string(), 0},
      "the camera has no event pixels; add 'events: {{}}', or leave {} out of --formats", format);
}

class RpgWriter : public Writer {
 public:
  explicit RpgWriter(const SequenceInfo& info) : Writer(info) {
    require_events(info, "events");
    if (info.calibration.optics.lens().distortion != sim::Lens::Distortion::equidistant) return;
    throw input::Error(info.scenario.camera.source,
                       "the camera has an equidistant distortion, and RPG's calib.txt has none; "
                       "leave events out of --formats, or give another camera.distortion");
  }

  void write(const FrameView& frame, FrameOutput& output) const override {
    const std::string name = fmt::format("images/frame_{:08}.png", frame.now.index);
    output.files.push_back(
        {fmt::format("rpg/{}", name), "", picture_path(frame.stamp_ns, info_.place)});
    output.rows["rpg_images"] = fmt::format("{} {}\n", seconds(frame.stamp_ns), name);
    output.rows["rpg_truth"] = pose_line(frame.stamp_ns, frame.now.truth.now.T_WC);
    std::string& events = output.rows["rpg_events"];
    for (const sim::Event& event : frame.now.events) {
      fmt::format_to(std::back_inserter(events), "{} {} {} {:d}\n",
                     seconds(info_.stamp_ns(event.t_ns)), event.x, event.y, event.is_on);
    }
    if (!info_.is_first()) return;
    std::string& imu = output.rows["rpg_imu"];
    for (const sim::ImuSample& sample : frame.now.imu) {
      const Eigen::Vector3d &a = sample.accel_mps2, &w = sample.gyro_radps;
      fmt::format_to(std::back_inserter(imu), "{} {} {} {} {} {} {}\n",
                     seconds(kEpoch_ns + sample.t_ns), a.x(), a.y(), a.z(), w.x(), w.y(), w.z());
    }
  }

  std::vector<SequenceDocument> documents() const override {
    const sim::Lens& lens = info_.calibration.optics.lens();
    std::vector<double> calibration{lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px};
    std::ranges::copy(lens.coefficients, std::back_inserter(calibration));
    calibration.resize(9);
    std::vector<SequenceDocument> all{
        {"rpg/calib.txt", {{.text = numbers(calibration, " ") + "\n"}}},
        {"rpg/images.txt", {{.stream = "rpg_images"}}},
        {"rpg/groundtruth.txt", {{.stream = "rpg_truth"}}},
        {"rpg/events.txt", {{.stream = "rpg_events"}}}};
    if (info_.is_first()) all.push_back({"rpg/imu.txt", {{.stream = "rpg_imu"}}});
    return all;
  }
};

class DsecWriter : public Writer {
 public:
  explicit DsecWriter(const SequenceInfo& info) : Writer(info) {
    require_events(info, "dsec");
    constexpr double kMost_s = 1e-6 * std::numeric_limits<std::uint32_t>::max();
    const double duration_s = info.scenario.frames / info.scenario.camera.rate_hz;
    if (duration_s <= kMost_s) return;
    throw input::Error({info.scenario.file.string(), 0},
                       fmt::format("the sequence takes {:.0f} s, and DSEC's times in 32 bits end "
                                   "after {:.0f} s; give fewer frames, or leave dsec out of "
                                   "--formats",
                                   duration_s, kMost_s));
  }

  void write(const FrameView& frame, FrameOutput& output) const override {
    std::string& events = output.rows["dsec"];
    for (const sim::Event& event : frame.now.events) {
      fmt::format_to(std::back_inserter(events), "{} {} {} {:d}\n", info_.stamp_ns(event.t_ns),
                     event.x, event.y, event.is_on);
    }
  }
  std::vector<SequenceDocument> documents() const override {
    return {{kDsecFile, {{.stream = "dsec"}}}};
  }
};

}  // namespace

const MakeWriter make_rpg_writer = make_writer<RpgWriter>;
const MakeWriter make_dsec_writer = make_writer<DsecWriter>;

}  // namespace lcs::sequence
