#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <ranges>
#include <stdexcept>

#include "scenarios/input/message.h"
#include "scenarios/shipped.h"
#include "tools/process/child.h"
#include "tools/sequence/writers.h"

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

}  // namespace lcs::sequence
