// Events: the text files of RPG's event-camera dataset, and DSEC's HDF5, which write_events.py
// makes by h5py.
#include <fmt/format.h>

#include <cmath>
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

/// By the clock of the camera.
std::int64_t stamp_ns(const SequenceInfo& info, const sim::Event& event) {
  return kEpoch_ns + event.t_ns - std::llround(1e9 * info.scenario.camera.time_offset_s);
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
      fmt::format_to(std::back_inserter(events), "{} {} {} {:d}\n", seconds(stamp_ns(info_, event)),
                     event.x, event.y, event.is_on);
    }
    if (!info_.is_first()) return;
    std::string& imu = output.rows["rpg_imu"];
    for (const sim::ImuSample& sample : frame.now.imu) {
      const Eigen::Vector3d &a = sample.accel_mps2, &w = sample.gyro_radps;
      fmt::format_to(std::back_inserter(imu), "{} {} {} {} {} {} {}\n",
                     seconds(kEpoch_ns + sample.t_ns), a.x(), a.y(), a.z(), w.x(), w.y(), w.z());
    }
  }

  std::vector<Document> documents() const override {
    const sim::Lens& lens = info_.calibration.optics.lens();
    std::vector<double> calibration{lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px};
    for (std::size_t i = 0; i < 5; ++i) {
      calibration.push_back(i < lens.coefficients.size() ? lens.coefficients[i] : 0);
    }
    std::vector<Document> all{{"rpg/calib.txt", {{.text = numbers(calibration, " ") + "\n"}}},
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
      fmt::format_to(std::back_inserter(events), "{} {} {} {:d}\n", stamp_ns(info_, event), event.x,
                     event.y, event.is_on);
    }
  }
  std::vector<Document> documents() const override { return {{kDsecFile, {{.stream = "dsec"}}}}; }
};

}  // namespace

std::string hdf5_library() {
  return run_script("write_events.py", {"--version"});
}

void write_hdf5(const std::filesystem::path& rows, const std::filesystem::path& out) {
  run_script("write_events.py", {rows.string(), out.string()});
}

std::unique_ptr<Writer> make_rpg_writer(const SequenceInfo& info) {
  return std::make_unique<RpgWriter>(info);
}
std::unique_ptr<Writer> make_dsec_writer(const SequenceInfo& info) {
  return std::make_unique<DsecWriter>(info);
}

}  // namespace lcs::sequence
