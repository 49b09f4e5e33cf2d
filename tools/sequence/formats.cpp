// The formats, and the README.md of a sequence.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <ranges>
#include <stdexcept>

#include "scenarios/input/message.h"
#include "scenarios/shipped.h"
#include "tools/process/child.h"
#include "tools/sequence/pose_text.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {

/// The texts of readme/. The head has fields in braces.
extern const std::string_view kEuroc, kTum, kKalibr, kKitti, kMcap, kRrd, kRpg, kDsec, kMot, kCoco,
    kDavis, kFlow, kDepth, kLandmarks, kPictures, kObjects, kHead;

namespace {

std::string camera_text(const sim::Lens& lens) {
  if (lens.is_pinhole()) {
    return fmt::format(
        "Camera: a pinhole without distortion, f = {} px in both directions, principal point ({}, "
        "{}).",
        lens.fu_px, lens.cu_px, lens.cv_px);
  }
  const sim::Pinhole pinhole = lens.pinhole();
  const bool is_fisheye = lens.distortion == sim::Lens::Distortion::equidistant;
  return fmt::format(
      R"(Camera: fx = {} px, fy = {} px, principal point ({}, {}),
distortion {} = [{}], as OpenCV {} has it. Pictures, depth, masks, boxes, flow and corners are
of the distorted picture. `truth.jsonl` alone is of the undistorted picture that detectors get from `lcs`, a pinhole with
f = {} px in both directions and the same principal point; labels of corners hold there.)",
      lens.fu_px, lens.fv_px, lens.cu_px, lens.cv_px,
      is_fisheye ? "k1, k2, k3, k4" : "k1, k2, p1, p2, k3", numbers(lens.coefficients, ", "),
      is_fisheye ? "(fisheye)" : "(pinhole)", pinhole.focal_px);
}

std::string shutter_text(const scenario::Camera& camera) {
  std::string text = "The picture is taken in an instant.";
  if (camera.exposure_s > 0) text = "All rows are taken at once.";
  if (camera.rolling_shutter_s > 0) {
    text = fmt::format(
        "The shutter rolls: row y shows the time of the frame plus y / {} of {} s.\n"
        "Depth, masks, boxes, flow and corners of a row are of its time, poses of the camera of "
        "the frame's.",
        camera.height_px, camera.rolling_shutter_s);
  }
  if (camera.exposure_s > 0) {
    text += fmt::format(
        " Each row is the mean of the light during {} s; all\ntruth is of the middle of this time.",
        camera.exposure_s);
  }
  return text;
}

std::string clocks_text(const scenario::Camera& camera) {
  if (camera.time_offset_s == 0) return "there is no delay between sensors.";
  return fmt::format(
      "the clock of\nthe camera, which stamps pictures and poses of the camera, is {} s {} the "
      "clock of the IMU (Kalibr's `timeshift_cam_imu`: {}).",
      std::abs(camera.time_offset_s), camera.time_offset_s > 0 ? "behind" : "ahead of",
      camera.time_offset_s);
}

std::string head(const SequenceInfo& info) {
  const scenario::Scenario& s = info.scenario;
  const sim::Lens& lens = info.calibration.optics.lens();
  return fmt::format(
      fmt::runtime(kHead), fmt::arg("name", s.name),
      fmt::arg("purpose", s.purpose.empty() ? s.name : s.purpose), fmt::arg("frames", s.frames),
      fmt::arg("rate", s.camera.rate_hz), fmt::arg("width", lens.width_px),
      fmt::arg("height", lens.height_px), fmt::arg("seed", s.seed),
      fmt::arg("gravity", info.calibration.gravity_mps2), fmt::arg("camera", camera_text(lens)),
      fmt::arg("origin", info.calibration.on_ground ? "origin on the ground below its middle"
                                                    : "origin at the IMU"),
      fmt::arg("samples", s.image.samples),
      fmt::arg("spread", std::hypot(s.image.point_spread_px, s.image.blur_px)),
      fmt::arg("epoch", kEpoch_ns), fmt::arg("shutter", shutter_text(s.camera)),
      fmt::arg("clocks", clocks_text(s.camera)), fmt::arg("reading", reading_text(s.imu)));
}

/// The cameras of a rig.
std::string rig_text(const SequenceInfo& info) {
  const std::vector<scenario::RigCamera>& cameras = info.scenario.cameras;
  if (cameras.empty()) return "";
  std::string text =
      "\n## Cameras\n\nAll take their pictures at the same instants. Files of another camera than "
      "cam0 are in a folder of its\nname, as `cam1/depth/<k>.png` beside `depth/<k>.png`, except "
      "in `mav0/` and `kitti/`, which have a place for each.\n`kalibr/camchain.yaml` has their "
      "poses to each other, `lcs.json` that in the rover (`T_BC`).\n\n| folder | name | camera "
      "|\n|---|---|---|\n";
  for (std::size_t i = 0; i < cameras.size(); ++i) {
    std::string lens = camera_text(info.rig[i]->optics.lens());
    std::ranges::replace(lens, '\n', ' ');
    text += fmt::format("| {} | {} | {} |\n", camera_name(i), cameras[i].name, lens);
  }
  return text;
}

constexpr const char* kExposures =
    "* `mav0/cam0/exposure.csv`: exposure and gain of each picture, which the picture before it "
    "has set.\n";

}  // namespace

const std::vector<Format>& formats() {
  static const std::vector<Format> kFormats{
      {"euroc", "IMU, truth and calibration, as EuRoC's ASL has them", kEuroc, euroc_writer, 0,
       260},
      {"tum", "trajectories: TUM's text files", kTum, tum_writer, 0, 90},
      {"kalibr", "calibration of camera and IMU: Kalibr's YAML", kKalibr, kalibr_writer},
      {"kitti", "pictures, projections and poses of rectified cameras: KITTI odometry", kKitti,
       kitti_writer, 0.001, 0, false},
      {"mcap", "messages of ROS 2 in a bag of MCAP; needs PyPI's rosbags", kMcap, mcap_writer, 0,
       600, false, 1},
      {"rrd", "all sensors and poses in a recording of Rerun; needs PyPI's rerun-sdk", kRrd,
       rrd_writer, 0, 250, false, 1},
      {"events", "events, pictures and IMU: text of RPG's event-camera dataset", kRpg, rpg_writer,
       10, 90, false},
      {"dsec", "events: DSEC's HDF5; needs h5py", kDsec, dsec_writer, 1.2, 0, false},
      {"mot", "boxes and tracks: MOTChallenge", kMot, mot_writer, 0.002, 0},
      {"coco", "boxes and masks: COCO's JSON", kCoco, coco_writer, 0.03, 0},
      {"davis", "masks: DAVIS's indexed PNG", kDavis, davis_writer, 0.015, 0},
      {"flow", "optical flow: KITTI's PNG and Middlebury's .flo", kFlow, flow_writer, 16.6, 0},
      {"depth", "depth: KITTI's 16-bit PNG", kDepth, depth_writer, 0.05, 0},
      {"landmarks", "the truth of every corner, CSV", kLandmarks, landmarks_writer, 0.36, 0},
  };
  return kFormats;
}

const std::vector<Use>& uses() {
  static const std::vector<Use> kUses{{"vio", {"euroc", "tum", "kalibr"}},
                                      {"detection", {"mot", "coco", "davis"}},
                                      {"flow", {"flow", "depth"}}};
  return kUses;
}

double estimated_bytes(const scenario::Scenario& scenario,
                       const std::vector<std::string>& formats) {
  // Bytes a pixel of the PNG: noise is not compressible, unless JPEG smoothed it.
  constexpr double kNoisy = 1.6, kSmooth = 0.4;
  const bool is_noisy = scenario.image.noise && !scenario.image.jpeg_quality;
  const double picture = is_noisy ? kNoisy : kSmooth;
  double a_pixel = picture, a_reading = 0;
  for (const std::string& name : formats) {
    a_pixel += format(name).bytes_a_pixel + format(name).pictures * picture;
    a_reading += format(name).bytes_a_reading;
  }
  double pixels = 0;
  const std::size_t cameras = std::max<std::size_t>(1, scenario.cameras.size());
  for (std::size_t place = 0; place < cameras; ++place) {
    const scenario::Camera camera = scenario::seen_by(scenario, place).camera;
    pixels += 1.0 * camera.width_px * camera.height_px;
  }
  const double readings = scenario.imu.rate_hz / scenario.camera.rate_hz;
  return scenario.frames * (a_pixel * pixels + a_reading * readings);
}

const Format& format(std::string_view name) {
  const auto found = std::ranges::find(formats(), name, &Format::name);
  if (found != formats().end()) return *found;
  const auto names = formats() | std::views::transform(&Format::name);
  throw std::invalid_argument(
      fmt::format("no format is called '{}'; there are {}", name, fmt::join(names, ", ")));
}

std::string run_script(const std::string& name, const std::vector<std::string>& arguments) {
  const process::PythonEnd end =
      process::run_python(scenario::shipped_folder("tools/sequence") / name, arguments);
  if (end.is_fine) return end.out;
  throw std::runtime_error(end.err.empty() ? name + " did not come to its end; run it again"
                                           : input::one_line(end.err));
}

std::string readme_text(const SequenceInfo& info, const std::vector<std::string>& formats) {
  std::string text = head(info) + std::string(kPictures);
  text.insert(text.find("\n## Files"), rig_text(info));
  if (info.scenario.image.auto_exposure) text += kExposures;
  for (const std::string& name : formats) text += format(name).readme;
  text += kObjects;
  for (const sim::Object& object : info.objects) {
    text += fmt::format("| {} | {} |\n", object.id, object.name);
  }
  return text;
}

}  // namespace lcs::sequence
