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
namespace {

constexpr std::string_view kEuroc = R"(
EuRoC ASL (`--formats euroc`); the body is the IMU:

* `mav0/imu0/data.csv`: gyro, then accelerometer, in S, noisy and biased; `sensor.yaml` has the noise that
  they are made with (Kalibr's model).
* `mav0/state_groundtruth_estimate0/data.csv`: exact, at every reading of the IMU: position of S in W,
  attitude `R_WS` as a quaternion w x y z, velocity of S in W, bias of gyro and accelerometer in S.
* `mav0/cam0/sensor.yaml`: intrinsics, and `T_BS`, here the pose of the camera in S.
* `mav0/cam0/pose.csv`: exact pose of the camera in W at each frame, as a 3x4 matrix row by row.
* `mav0/odometry0/`: where the rover has it, velocity of B in B and yaw rate, by its wheels.
)";
constexpr std::string_view kTum = R"(
TUM (`--formats tum`), a pose a line, `t_s x y z qx qy qz qw`, exact:

* `tum/camera.txt`: of C in W at each frame; `tum/imu.txt`: of S in W at each reading of the IMU.
)";
constexpr std::string_view kKalibr = R"(
Kalibr (`--formats kalibr`):

* `kalibr/camchain.yaml`: intrinsics, distortion, `T_cam_imu`; `kalibr/imu.yaml`: noise of the IMU.
)";
constexpr std::string_view kKitti = R"(
KITTI odometry (`--formats kitti`), of cameras without distortion, side by side:

* `kitti/image_<i>/<k>.png`: the pictures of camera i under other names, in colour; `kitti/times.txt`: seconds, by
  the clock of the camera, 0 at time 0 of the simulation; `kitti/poses.txt`: `T_WC` of camera 0, 12 numbers a line (KITTI's own begin at the identity).
* `kitti/calib.txt`: `P<i>`, row by row, projects a point in camera 0 to the pixels of camera i.
)";
constexpr std::string_view kMcap = R"(
ROS 2 (`--formats mcap`): `rosbag/`, a rosbag2 of MCAP, with standard messages:

* `/cam<i>/image_raw/compressed`: the PNGs byte by byte, `/cam<i>/camera_info`, `/cam<i>/detections` (vision_msgs/Detection2DArray: the
  box of what is seen of each object, `id` as in all files, pixels as above).
* `/imu0`: readings, without an attitude; `/odometry0`: velocities by the wheels, in B, without a pose.
* `/tf`: exact pose of S in W, `world` to `imu`; `/tf_static`: cameras (`cam<i>_optical`) and rover (`base`) in S;
  `/truth/odometry`: exact pose of cam0 in W, and its velocity and body rate in C.
)";
constexpr std::string_view kRpg = R"(
RPG's event-camera dataset (`--formats events`); times in seconds, by the clock of the camera (`imu.txt`: of the IMU):

* `rpg/events.txt`: an event a line, `t x y p`: p is 1 where light has grown, 0 where it has fallen. Pixels are as in the pictures.
* `rpg/images.txt`, `rpg/images/`: the pictures of `mav0/cam0/data` under other names, in colour; `rpg/calib.txt`: `fx fy cx cy k1 k2 p1 p2 k3`.
* `rpg/groundtruth.txt`: `t x y z qx qy qz qw`, exact pose of C in W at each frame; `rpg/imu.txt`: `t ax ay az gx gy gz`, in S.
)";
constexpr std::string_view kDsec = R"(
DSEC (`--formats dsec`):

* `dsec/events.h5`: `/events/{t,x,y,p}` as in `rpg/events.txt`; t in microseconds after `/t_offset`; `/ms_to_idx`: the first event of each
  millisecond. DSEC itself compresses by Blosc, this file by HDF5's own gzip.
)";
constexpr std::string_view kMot = R"(
MOTChallenge (`--formats mot`); frames, ids and pixels count from 1:

* `mot/<name>/gt/gt.txt`: `frame,id,left,top,width,height,conf,class,visibility`: the box of what is seen of
  each object. `conf` is 0 (to be ignored) for objects that stand still all the time; `class` is MOTChallenge's (1 for
  pedestrians, 3 for cars), 8 (distractor) for a class that it lacks; `visibility` is the share of the full silhouette that is seen, parts
  outside of the picture included in the full one.
* `mot/<name>/seqinfo.ini`, `mot/<name>/img1/`: the pictures of `mav0/cam0/data` under other names.
)";
constexpr std::string_view kCoco = R"(
COCO (`--formats coco`); ids count from 1, pixels from 0:

* `coco/annotations.json`: `bbox` [x, y, width, height] and mask (runs, not compressed) of what is seen of
  each object; `file_name` is relative to this folder; `track_id` is the object's id, `category_id` its kind.
)";
constexpr std::string_view kDavis = R"(
DAVIS (`--formats davis`):

* `davis/Annotations/480p/<name>/<k>.png`: indexed PNG: 0 background (the sky included), 1 to n objects,
  254 the rover itself (void).
)";
constexpr std::string_view kFlow = R"(
Optical flow (`--formats flow`), forward: where the surface at a pixel of frame k is in frame k+1, minus
the pixel; x right, y down, in pixels. There is none for the last frame. `flow/` has the whole motion,
moving objects included, `flow_ego/` the camera's own part, as if everything else stood still:

* `flow/kitti/<k>.png`: KITTI's 16-bit PNG: u = (red - 2^15) / 64, v = (green - 2^15) / 64, blue is 1
  where the surface is seen in frame k+1; where it is hidden there, leaves the picture, moves by more than 511 px
  or is the rover itself, all three are 0. In `flow_ego/` moving objects are valid where they
  would be within the picture.
* `flow/middlebury/<k>.flo`: 32-bit float, also for what is hidden in frame k+1 or leaves the picture;
  1e10 (unknown) on the rover itself and for points behind the camera.
)";
constexpr std::string_view kDepth = R"(
Depth (`--formats depth`):

* `depth/<k>.png`: 16-bit PNG, depth in metres * 256: along the optical axis (the z of C), **not** the
  length of the ray. 0 where there is none: the sky, and beyond 255.99 m.
)";
constexpr std::string_view kLandmarks = R"(
Landmarks (`--formats landmarks`):

* `landmarks.csv`: a row for each FAST corner of each frame: its place, the id of the object that it is on (0: the
  fixed setting; -1: the sky or the rover itself, no landmark), the depth (z of C) of the nearest surface in the 3x3 pixels
  round it, its motion to frame k+1 in pixels, the motion that it would have if its object stood
  still, and its label: `fixed`; `rebel`: its object moves, and the two motions differ by 1 px or more;
  `indistinct`: its object moves, and they do not; `none`: no landmark, or within 3 px of
  the edge of a shadow. `radial` is 1 for a rebel that
  moves as a static point at another depth would, to within 1 px. Empty where it is not defined.
* `truth.jsonl`: the same and the boxes and masks of objects in the form of a run's own file, a JSON object a line: what
  `lcs replay` scores detectors by.
)";

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
