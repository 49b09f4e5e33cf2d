/// \file
/// The typed form of a scenario file: the complete description of a run.
///
/// Loading validates a `Scenario` (`scenarios/load.h`); it does not change afterwards. All values
/// are SI with angles in radians, independent of the units in the YAML file. `scenarios/README.md`
/// explains the sections and units, and `fields.h` lists the keys.
///
/// World frame W: z up, right-handed, metres. Rover frame B: x forward, y left, z up, origin on the
/// ground below the middle of the rover.
#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <filesystem>
#include <map>
#include <numbers>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "scenarios/input/error.h"

namespace lcs::scenario {

enum class Drive {
  holonomic,  ///< planar base that follows any velocity command at once, as the paper assumes
  wheeled,    ///< two driven wheels and two casters with contacts; rough ground shakes the camera
  own,  ///< from a file; its actuators determine which of the two it is (`sim/scene/fragment.h`)
};

/// The ego's command from `at_s` until the next phase begins.
struct EgoPhase {
  double at_s = 0;
  double speed_mps = 0;          ///< at the start of the phase, >= 0
  double acceleration_mps2 = 0;  ///< along the direction of travel; the speed stops at 0
  /// Direction of travel relative to the heading, ccw: pi/2 is to the left, pi is reverse.
  double direction_rad = 0;
  double yaw_rate_radps = 0;  ///< ccw
};

/// A position on the ground with its time.
struct Waypoint {
  double at_s = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
};

/// A pose of the rover's frame B in W, with its time. Attitude: R = Rz(yaw) Ry(pitch) Rx(roll).
struct PathPose {
  double at_s = 0;
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
  Eigen::Vector3d rpy_rad = Eigen::Vector3d::Zero();
};

struct Ego {
  input::Source source;
  Drive drive = Drive::holonomic;
  std::filesystem::path drive_file;  ///< for `Drive::own`: MJCF file, exists
  /// Of the joints beside the drive: a keyframe of its file, or `kPoseZero`; "": they are loose.
  std::string pose;
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  std::vector<EgoPhase> phases;  ///< at least one; the first has time 0, times increase
  /// Replace all phases. At least two, not all at one position; times increase from 0 or later. The
  /// rover starts at the first waypoint, heading to the next different one; `sim/world/route.h`
  /// describes its motion.
  std::vector<Waypoint> waypoints;
  /// Replaces drive, phases and waypoints: a camera that is carried or flies, without a vehicle. At
  /// least two; times increase from 0 or later. `sim/world/path.h` describes its motion.
  std::vector<PathPose> path;

  /// Whether there is no vehicle: `path` says where the camera is.
  bool is_carried() const { return !path.empty(); }
};

/// OpenCV's distortion models. Both begin with the radial coefficients.
struct Distortion {
  bool equidistant = false;          ///< else radial and tangential
  std::vector<double> coefficients;  ///< k1 k2 p1 p2 k3, or k1 k2 k3 k4 if `equidistant`
};

struct Camera {
  input::Source source;
  int width_px = 640;
  int height_px = 480;
  double fovy_rad = std::numbers::pi / 3;    ///< vertical field of view, (0, pi), if undistorted
  std::optional<Eigen::Vector2d> focal_px;   ///< fx, fy; absent: both by `fovy_rad`
  std::optional<Eigen::Vector2d> centre_px;  ///< principal point; absent: the picture's middle
  std::optional<Distortion> distortion;      ///< absent: straight lines stay straight
  double rate_hz = 10;
  Eigen::Vector3d mount_position_m{0.2, 0, 0.45};  ///< position of the camera in B
  /// Roll, pitch, yaw about B's fixed x, y, z in this order: R = Rz(yaw) Ry(pitch) Rx(roll). With
  /// all 0 the camera looks along B's x, upright; positive pitch is down, positive yaw is left.
  Eigen::Vector3d mount_rpy_rad = Eigen::Vector3d::Zero();
  /// Errors of the calibration that the filter gets: its height and pitch of the mount and its time
  /// offset are the true ones plus these.
  struct Told {
    double height_error_m = 0;
    double pitch_error_rad = 0;
    double time_offset_error_s = 0;
  } told;
  /// A frame that shows the time t of the IMU's clock has the stamp t - time_offset: Kalibr's
  /// `timeshift_cam_imu`.
  double time_offset_s = 0;
  /// Time from the first row to the end of the last row. Row y of h shows the time of the frame
  /// plus y / h of it. 0: all rows show the time of the frame.
  double rolling_shutter_s = 0;
  /// Time during which a row collects light, with the row's time in its middle. It smears the
  /// picture; its brightness depends on `Image::exposure_s` alone. 0: an instant.
  double exposure_s = 0;
  std::vector<int> groups{0, 1, 2};  ///< MuJoCo's groups whose geoms are drawn, each once
};

/// One camera of a rig.
struct RigCamera {
  std::string name;
  input::Source source;
  Camera camera;
};

/// Kalibr's noise model with a turn-on bias, see `sim/imu/imu_noise.h`. With all 0 the IMU is
/// ideal.
struct ImuNoise {
  double gyroscope_noise_density = 0;      ///< rad/s/sqrt(Hz)
  double gyroscope_random_walk = 0;        ///< rad/s^2/sqrt(Hz)
  double accelerometer_noise_density = 0;  ///< m/s^2/sqrt(Hz)
  double accelerometer_random_walk = 0;    ///< m/s^3/sqrt(Hz)
  /// \name Standard deviation of the turn-on bias, drawn once per run for each axis.
  ///@{
  double gyroscope_turn_on_bias_radps = 0;
  double accelerometer_turn_on_bias_mps2 = 0;
  ///@}

  bool operator==(const ImuNoise&) const = default;
};

/// \name Errors of the sensors of an IMU, beside `ImuNoise`. With w and f the true rate and
/// specific force in the IMU's frame, the sensors read, before noise,
///
///     M_gyro C_gyro_i w + A C_gyro_i f   and   M_accel f
///
/// as in Kalibr's model "scale-misalignment". Noise is added; then values beyond the range become
/// the range, and all become multiples of the resolution.
///@{
struct Gyroscopes {
  Eigen::Matrix3d M = Eigen::Matrix3d::Identity();         ///< lower triangular
  Eigen::Matrix3d C_gyro_i = Eigen::Matrix3d::Identity();  ///< rotation, IMU's frame to gyroscopes'
  Eigen::Matrix3d A = Eigen::Matrix3d::Zero();             ///< (rad/s) / (m/s^2)
  std::optional<double> range_radps;                       ///< absent: unlimited
  std::optional<double> resolution_radps;                  ///< absent: unlimited

  bool operator==(const Gyroscopes&) const = default;
};
struct Accelerometers {
  Eigen::Matrix3d M = Eigen::Matrix3d::Identity();  ///< lower triangular
  std::optional<double> range_mps2;                 ///< absent: unlimited
  std::optional<double> resolution_mps2;            ///< absent: unlimited

  bool operator==(const Accelerometers&) const = default;
};
///@}

/// The interval [from_s, to_s).
struct TimeSpan {
  double from_s = 0;
  double to_s = 0;
};

/// What an IMU's reading tells; `sim/imu/imu.h` has both definitions.
enum class ImuReading {
  mean,    ///< over the time since the reading before, as of a unit that integrates its rates
  sample,  ///< of the instant of its stamp
};

struct Imu {
  /// adis16448, tumvi, esim, ideal, or custom when a key overrides the preset.
  std::string preset = "adis16448";
  ImuNoise noise;
  Gyroscopes gyroscopes;
  Accelerometers accelerometers;
  std::optional<Eigen::Vector3d> position_m;  ///< of the IMU in B; absent: as in the rover's file
  /// As `Camera::mount_rpy_rad`, of the IMU's axes; absent: as in the rover's file.
  std::optional<Eigen::Vector3d> rpy_rad;
  ImuReading reading = ImuReading::mean;
  double rate_hz = 200;
  std::vector<TimeSpan> gaps;  ///< without readings, in order; each begins after 0
};

/// Wheel odometry: velocity of B in B, and yaw rate, at its own rate.
struct Odometry {
  bool enabled = false;
  double rate_hz = 50;
  double noise_mps = 0.01;        ///< white, per sample and axis
  double yaw_noise_radps = 0.05;  ///< white, per sample of the yaw rate; for wheels 0.4 m apart
  double scale_error = 0.005;     ///< standard deviation of a scale drawn once per run
};

/// Event pixels behind the camera's lens, one for each pixel of its pictures, as in a DAVIS.
/// `sim/events/event_sensor.h` has the model. Contrasts are differences of the natural logarithm of
/// light.
struct Events {
  input::Source source;
  double positive = 0.2;       ///< mean contrast of an ON event, > 0
  double negative = 0.2;       ///< mean contrast of an OFF event, > 0
  double spread = 0.03;        ///< standard deviation of both between pixels
  double refractory_s = 5e-4;  ///< after an event the pixel gives none for this long
  double leak_hz = 0.1;        ///< ON events a second of a pixel that sees constant light
  double shot_hz = 1;          ///< events by noise of a pixel in the dark, a second
  double dark_lx = 0.1;        ///< light on a white surface that equals the dark current
};

enum class CornerSource {
  pictures,  ///< FAST in each picture
  events,    ///< Arc* in the events (`filter/detect/event_corners.h`)
};

enum class EgoMotionSource {
  imu,    ///< strapdown integration of the simulated IMU (and odometry if enabled)
  truth,  ///< exact poses, for experiments that state this
};

/// The imaging of the scene; `sim/camera/photograph.h` has the model. The defaults only add sensor
/// noise to the rendered image, in which a white surface in daylight is white. Without noise they
/// leave the image unchanged.
struct Image {
  static constexpr double kDaylight_lx = 10000;  ///< overcast day
  static constexpr double kDaylightExposure_s = 1e-3;

  struct Headlights {
    double intensity_cd = 0;                 ///< along the optical axis
    double beam_rad = std::numbers::pi / 9;  ///< standard deviation of the beam around the axis
  };
  struct Rain {
    double rate_mmph = 0;    ///< rain rate, mm/h
    int lens_drops = 0;      ///< on the window in front of the lens at any time
    double drop_life_s = 4;  ///< mean time until a drop runs off and another lands
  };
  /// Changes exposure and gain from frame to frame; `sim/camera/exposure_control.h` has the law.
  /// `exposure_s` and `gain` then hold for the first frame only.
  struct AutoExposure {
    double target = 0.2;           ///< mean of the picture in linear light, (0, 1)
    double time_constant_s = 0.2;  ///< in which a deviation falls to 1/e; 0: within a frame
    std::optional<Eigen::Vector2d> exposure_s;  ///< least and most; absent: it stays the same
    Eigen::Vector2d gain{1, 16};                ///< least and most
  };
  struct Noise {
    double full_well_e = 10000;  ///< electrons of a saturated pixel
    double read_e = 5;           ///< standard deviation of the read noise, electrons
  };

  double light_lx = kDaylight_lx;  ///< on the scene, without the rover's own lights
  bool shadows = false;            ///< of the scene's lights that have `castshadow`
  std::optional<Headlights> headlights;
  std::optional<double> visibility_m;  ///< at which contrast falls to 2 %; absent: clear air
  std::optional<Rain> rain;
  int samples = 5;  ///< of the light that falls on each pixel: 1, 4, 5 or 9
  /// Standard deviation of a sharp lens's point spread. With a pixel's area it leaves half of the
  /// contrast at .28 cycles a pixel: a sharp camera as slanted edges (ISO 12233) measure it.
  double point_spread_px = 0.6;
  double blur_px = 0;  ///< standard deviation, in addition to the sharp lens's
  /// Share of the light that a corner of the picture loses; it grows with the squared distance from
  /// the principal point to the farthest corner.
  double vignetting = 0;
  double exposure_s = kDaylightExposure_s;
  double gain = 1;
  std::optional<AutoExposure> auto_exposure;  ///< absent: exposure and gain stay the same
  std::optional<Noise> noise = Noise{};       ///< absent: a sensor without noise
  std::optional<int> jpeg_quality;            ///< 1 to 100; absent: no compression
};

/// Rough ground that wheels feel and the camera sees: a Gaussian random field.
struct RoughGround {
  double roughness_m = 0.01;  ///< standard deviation of the height
  double wavelength_m = 0.6;  ///< of the shortest waves; the longest are three times as long
  std::optional<Eigen::Vector2d> centre_m;  ///< absent: the ego's start
  Eigen::Vector2d size_m{8, 4};             ///< along x and y; flat at the edges
};

/// \name Trajectories of actors, on the ground plane. An actor faces its direction of motion.
///@{
struct Still {
  std::optional<Eigen::Vector2d> position_m;  ///< absent: the body's position in the scene
  std::optional<double> heading_rad;
};
struct Line {
  std::optional<Eigen::Vector2d> from_m;  ///< absent: the body's position in the scene
  std::optional<double> heading_rad;      ///< absent: the body's heading in the scene
  double speed_mps = 0;                   ///< >= 0
  double acceleration_mps2 = 0;           ///< the speed stops at 0: "comes and parks"
};
/// At least two; straight and uniform in between. Times count from the start trigger, and increase.
using Waypoints = std::vector<Waypoint>;
struct Circular {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double radius_m = 0;  ///< > 0
  double start_angle_rad = 0;
  double speed_mps = 0;  ///< > 0: ccw
};
///@}
using Trajectory = std::variant<Still, Line, Waypoints, Circular>;

/// The value of a joint with its time.
struct JointPoint {
  double at_s = 0;
  double value = 0;       ///< MuJoCo's position of the joint, rad or m
  bool is_angle = false;  ///< given in a unit of angles
};
/// The motion of a hinge or slide in a body of the scene, by `Waypoints`' rules.
struct JointMotion {
  std::string name;
  input::Source source;
  std::vector<JointPoint> points;
};

/// An actor waits at the first point of its trajectory until its trigger fires.
struct StartTrigger {
  double at_s = 0;                     ///< earliest start
  std::optional<double> ego_within_m;  ///< required distance to the ego, at most
};

enum class Shape { box, cylinder, pedestrian, car, walker, own };

/// `Actor::pose` for all joints at zero, MuJoCo's reference.
inline constexpr const char* kPoseZero = "zero";
/// `Actor::pose` for limbs that walk (`sim/scene/gait.h`).
inline constexpr const char* kPoseWalking = "walking";

struct Actor {
  std::string name;
  input::Source source;
  std::optional<std::string>
      body;  ///< moves this body of the scene; absent: adds an actor of `shape`
  Shape shape = Shape::box;
  std::filesystem::path shape_file;  ///< for `Shape::own`: MJCF file, exists
  std::optional<Eigen::Vector3d>
      size_m;           ///< length (x), width (y), height (z); absent: the shape's default
  std::string texture;  ///< style of the procedural texture, or a PNG file; "": the shape's own
  /// Of its joints: a keyframe of its file, `kPoseZero` or `kPoseWalking`; "": it has none, or
  /// `kPoseWalking` for a walker.
  std::string pose;
  std::string kind;  ///< class in COCO and MOT; "": the class of its shape
  Trajectory trajectory;
  std::vector<JointMotion> joints;  ///< of `body`; given in place of a trajectory: the body stays
  StartTrigger start;

  bool stands() const { return joints.empty() && std::holds_alternative<Still>(trajectory); }
  bool walks() const {
    return pose == kPoseWalking || (!body && shape == Shape::walker && pose.empty());
  }
};

/// The names of the on-disk layouts of recordings (`tools/replay/recorded.h` reads them).
inline constexpr std::array<const char*, 13> kRecordingFormats{
    "euroc",    "kitti",    "kitti_odometry", "kitti_tracking", "kitti_360",
    "robotcar", "tum_rgbd", "rpg_events",     "listed",         "mot",
    "bag",      "video",    "pictures"};

/// Frames of a real camera, instead of a simulation's. The layout supplies values that are absent
/// here; others are unknown, never invented. Camera frame: x right, y down, z forward.
struct RecordingSource {
  enum class Split { train, validate, test };
  /// Of a ROS bag; "": the only one of its kind.
  struct Topics {
    std::string image, camera_info, imu, poses, odometry;
    std::string world;  ///< frame of poses that come from tf
  };

  input::Source source;
  std::filesystem::path path;  ///< a folder, a video or a bag; exists
  std::string format;          ///< of `kRecordingFormats`; "": detected
  std::string camera;          ///< name of a camera; "": the layout's first
  Topics topics;
  std::optional<double> fps;                   ///< images per second
  std::optional<std::filesystem::path> times;  ///< of the images: a table, exists
  std::string time_unit;  ///< of tables: s, ms, us or ns; "": as they state it themselves
  int every = 1;          ///< a frame is each n-th image, from the first image on
  /// \name Motion of the camera; each file exists.
  ///@{
  std::optional<std::filesystem::path> poses;     ///< T_WC, in lines of TUM or of KITTI odometry
  std::optional<std::filesystem::path> imu;       ///< columns as in EuRoC
  std::optional<std::filesystem::path> odometry;  ///< velocity, in EuRoC's style; needs an IMU
  std::optional<double> speed_mps;                ///< along the optical axis; 0: at rest
  std::optional<double> time_offset_s;  ///< as `Camera::time_offset_s`, to the IMU's clock
  ///@}
  std::optional<std::filesystem::path> calibration;      ///< of the camera; exists
  std::optional<std::filesystem::path> imu_calibration;  ///< noise, as Kalibr has it; exists
  std::optional<Eigen::Vector2d> focal_px;               ///< fx, fy
  std::optional<Eigen::Vector2d> centre_px;
  std::optional<Distortion> distortion;
  std::string bayer;        ///< pattern of raw images from the top left, as "rggb"; "": none
  std::optional<int> bits;  ///< in use of 16-bit images
  std::optional<double> camera_height_m;         ///< above the ground
  std::optional<Eigen::Vector3d> mount_rpy_rad;  ///< as `Camera::mount_rpy_rad`
  std::optional<std::filesystem::path> mask;     ///< an image: white is the vehicle itself
  std::optional<double> at_rest_s;               ///< duration of rest from the start on
  std::optional<std::filesystem::path> labels;   ///< boxes of the moving objects
  std::string labels_video;                      ///< of several in the file; "": the only one
  bool nothing_moves = false;
  std::optional<Split> split;  ///< purpose of its figures
};

/// A filter setting in the filter's vocabulary; the scenario only passes it on.
struct FilterSetting {
  std::string key;    ///< for example "circle.mu_0"
  std::string value;  ///< as written
  input::Source source;
};

/// A bound on a metric of the run. A failed required criterion makes the command exit with 1.
struct Criterion {
  std::string metric;  ///< a key of metrics.json
  std::optional<double> min;
  std::optional<double> max;
  bool required = true;
  input::Source source;
  std::string detector = {};  ///< name in the run of the tested detector; "": the run's own
  std::string over = "seed";  ///< one of `kOver`
};

/// How a suite judges a criterion: each seed's figure, their mean, or the 95 % interval of the
/// mean.
inline constexpr std::array<const char*, 3> kOver{"seed", "mean", "interval"};

/// A key that a sweep gives several values; each is YAML text as for `--set`.
struct SweptKey {
  struct Value {
    std::string text;
    input::Source source;
  };
  std::string key;  ///< for example "ego.speed"
  std::vector<Value> values;
  input::Source source;
};

/// The generated world (`lcs world`) that a scene was made from. It identifies the world across
/// scene names, run seeds, scenarios and image sequences.
struct Origin {
  input::Source source = {};
  std::string family = {};  ///< "room"
  std::uint64_t seed = 0;   ///< the generator's seed; a run may have another seed
  std::uint64_t again = 0;  ///< number of worlds of this seed that were rejected before this one
  std::vector<std::string> features = {};  ///< features of the world

  bool is_same_world(const Origin& other) const {
    return family == other.family && seed == other.seed;
  }
};
/// The name of the MJCF text in which a scene states its origin: `<custom><text name="lcs.world"
/// data="room 7"/></custom>`.
inline constexpr const char* kOriginText = "lcs.world";

inline constexpr int kFastThreshold = 20;

struct Scenario {
  std::string name;  ///< the file's stem
  std::filesystem::path file;
  std::string purpose;                          ///< one line
  std::vector<std::string> groups = {"short"};  ///< at least one
  /// Replaces `scene`, `ego`, `camera`, `imu`, `odometry`, `image`, `ground` and `actors`, which
  /// then keep their defaults.
  std::optional<RecordingSource> recording;
  std::filesystem::path scene;  ///< MJCF file, exists
  input::Source scene_source;
  std::string pose;  ///< of the scene's joints: a keyframe, or `kPoseZero`; "": they are loose
  std::optional<Origin> origin;  ///< as stated in the scenario file; the scene may state one, too
  std::uint64_t seed = 1;  ///< of all random streams: textures, IMU noise, odometry and others
  int frames = 0;          ///< > 0; for a recording: the most, and 0 for all of its frames
  Ego ego;
  Camera camera;                   ///< the detectors' camera; in a rig, one of `cameras`
  std::vector<RigCamera> cameras;  ///< of a rig, all of one rate; empty for a single camera
  std::string filter_camera;       ///< the detectors' camera in the rig; "": no rig, or its first
  std::size_t rig_place = 0;       ///< of `camera` in `cameras`
  Imu imu;
  Odometry odometry;
  EgoMotionSource ego_motion = EgoMotionSource::imu;
  std::optional<Events> events;  ///< absent: no event pixels
  CornerSource corner_source = CornerSource::pictures;
  /// Threshold of FAST, 1 to 254 grey levels; absent: adaptive per image (`threshold: auto`).
  std::optional<int> fast_threshold = kFastThreshold;
  double truth_min_depth_m = 0.5;  ///< least depth of the static segment (`radial`)
  Image image;
  std::optional<RoughGround> ground;  ///< absent: the scene's own ground
  std::vector<Actor> actors;
  std::string filter_preset;  ///< "": the filter's default
  input::Source filter_preset_source;
  std::vector<FilterSetting> filter;
  std::vector<Criterion> criteria;
  /// The keys that determine sensor data and truth, except for the seed, as written: {"ego.speed",
  /// "0.5 m/s"}. Keys for recording and judging a run are not included.
  std::map<std::string, std::string> world;
  /// A run of the scenario itself ignores `sweep` and uses the file's other values; see
  /// `scenarios/sweep.h`.
  std::vector<SweptKey> sweep;
};

/// The scenario as one camera of its rig sees it. \param place in `cameras`; 0 without a rig.
inline Scenario seen_by(Scenario scenario, std::size_t place) {
  if (!scenario.cameras.empty()) scenario.camera = scenario.cameras.at(place).camera;
  scenario.rig_place = place;
  return scenario;
}

}  // namespace lcs::scenario
