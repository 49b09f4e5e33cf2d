#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/sequence/pose_text.h"
#include "tools/sequence/writer.h"

namespace lcs::sequence {
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
      R"(# {name}

{purpose}.

{frames} frames at {rate} Hz, {width}x{height} pixels, seed {seed}; made by `lcs generate` from `scenario.yaml`.
`manifest.json` has the versions of all that took part, and size and SHA-256 of every file.

## Units, frames, axes

SI units and radians, unless a file's own format has others. Right-handed frames; `T_AB` takes the
coordinates of a point in B to those in A.

| frame | axes |
|---|---|
| W, world (EuRoC's R) | z up; gravity is {gravity} m/s^2 along -z |
| B, rover | x ahead, y left, z up; {origin} |
| S, IMU (EuRoC's body) | as `T_BS` in `lcs.json` has it; an accelerometer at rest reads +{gravity} m/s^2 upwards |
| C, camera | x right, y down, z forward |

{camera}
Pixels: x right, y down, (0, 0) is the centre of the top-left one. Their values are sRGB codes of linear light,
the mean of {samples} points of the pixel behind a lens that spreads a point by {spread:.3g} px (standard deviation).
Depth, masks, boxes and flow are of the pixel's middle. {shutter}

Frames count from 0 (in MOTChallenge's and COCO's files from 1). Times are nanoseconds, {epoch} at the
first frame, which is time 0 of the simulation: frame k is at {epoch} + round(k * 10^9 / {rate}).
Sample i of a sensor is at {epoch} + round(i * 10^9 / its rate). Picture, depth, masks, boxes and poses of a frame
belong to the very same moment; {clocks}
Of the IMU {reading}.

## Files
)",
      fmt::arg("name", s.name), fmt::arg("purpose", s.purpose.empty() ? s.name : s.purpose),
      fmt::arg("frames", s.frames), fmt::arg("rate", s.camera.rate_hz),
      fmt::arg("width", lens.width_px), fmt::arg("height", lens.height_px),
      fmt::arg("seed", s.seed), fmt::arg("gravity", info.calibration.gravity_mps2),
      fmt::arg("camera", camera_text(lens)),
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

constexpr const char* kPictures = R"(
* `mav0/cam0/data/<ns>.png`, `mav0/cam0/data.csv`: the pictures, 8-bit colour, and their list.
* `lcs.json`: how `lcs replay` sets up the detectors for the same bits as `lcs run` gives; `origin` is the world of `lcs world` that the pictures are of, if they are of one.
* `scenario.yaml`: the scenario, with the values of the command line. Its relative paths begin at the folder of the file that was given.
)";

constexpr const char* kExposures =
    "* `mav0/cam0/exposure.csv`: exposure and gain of each picture, which the picture before it "
    "has set.\n";

constexpr const char* kObjects = R"(
## Objects

Ids are the same in all files:

| id | name |
|---|---|
)";

}  // namespace

std::string readme_text(const SequenceInfo& info, const std::vector<std::string>& formats) {
  std::string text = head(info) + kPictures;
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
