/// \file
/// What a run is made of: the typed form of a scenario file.
///
/// A `Scenario` is validated when it is loaded (`scenarios/load.h`) and never changed afterwards.
/// All values are SI with angles in radians, whatever the YAML wrote; the YAML vocabulary and the
/// units it accepts are in `scenarios/README.md`.
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
#include <stdexcept>
#include <string>
#include <variant>
#include <vector>

namespace lcs::scenario {

/// Where a value was written, so that what is found wrong with it later (a body that the scene does
/// not have) can still be reported at its line.
struct Source {
  std::string file;  ///< or the whole assignment, as in "--set ego.speed=1"
  int line = 0;      ///< from 1; 0 is the file as a whole, or an assignment
};

/// The one message that a user gets: "file:line: what is wrong; what to do", without the line where
/// there is none.
class Error : public std::runtime_error {
 public:
  Error(const Source& where, const std::string& what_and_remedy);
};

enum class Drive {
  holonomic,  ///< planar base that follows any velocity command at once: the paper's assumption
  wheeled,    ///< two driven wheels and two casters on contacts; the camera shakes on rough ground
  own,        ///< of a file, in one of these ways: its actuators say in which (`sim/fragment.h`)
};

/// The command that the ego follows from `at_s` on, until the next phase begins.
struct EgoPhase {
  double at_s = 0;
  double speed_mps = 0;          ///< at the start of the phase, >= 0
  double acceleration_mps2 = 0;  ///< along the direction of travel; speed stops at 0
  /// Where it drives to, relative to its heading, ccw: pi/2 is to the left, pi is reverse.
  double direction_rad = 0;
  double yaw_rate_radps = 0;  ///< ccw
};

/// A place on the ground, to be at a time.
struct Waypoint {
  double at_s = 0;
  Eigen::Vector2d position_m = Eigen::Vector2d::Zero();
};

struct Ego {
  Source source;
  Drive drive = Drive::holonomic;
  std::filesystem::path drive_file;  ///< of `Drive::own`: MJCF, which exists
  Eigen::Vector2d start_m = Eigen::Vector2d::Zero();
  double heading_rad = 0;
  std::vector<EgoPhase> phases;  ///< at least one; the first is at 0, times increase
  /// Take the place of all phases. There are at least two, not all at one place, and their times
  /// increase from 0 or later. The rover starts at the first one and heads where it goes;
  /// `sim/route.h` says how it drives from one to the next.
  std::vector<Waypoint> waypoints;
};

struct Camera {
  int width_px = 640;
  int height_px = 480;
  double fovy_rad = std::numbers::pi / 3;  ///< vertical field of view, (0, pi)
  double rate_hz = 10;
  Eigen::Vector3d mount_position_m{0.2, 0, 0.45};  ///< of the camera in B
  /// Roll, pitch, yaw about B's fixed x, y, z in this order: R = Rz(yaw) Ry(pitch) Rx(roll). All 0
  /// looks along B's x, upright; positive pitch looks down, positive yaw to the left.
  Eigen::Vector3d mount_rpy_rad = Eigen::Vector3d::Zero();
  /// What a calibration that is not perfect tells of the mount: the true height and pitch plus
  /// these.
  struct Told {
    double height_error_m = 0;
    double pitch_error_rad = 0;
  } told;
};

/// Kalibr's noise model and a turn-on bias, see `sim/imu_noise.h`. All 0 is the ideal IMU.
struct ImuNoise {
  double gyroscope_noise_density = 0;      ///< rad/s/sqrt(Hz)
  double gyroscope_random_walk = 0;        ///< rad/s^2/sqrt(Hz)
  double accelerometer_noise_density = 0;  ///< m/s^2/sqrt(Hz)
  double accelerometer_random_walk = 0;    ///< m/s^3/sqrt(Hz)
  /// \name Standard deviation of a bias drawn for each axis once a run, as it differs from one time
  /// that the IMU is switched on to the next.
  ///@{
  double gyroscope_turn_on_bias_radps = 0;
  double accelerometer_turn_on_bias_mps2 = 0;
  ///@}

  bool operator==(const ImuNoise&) const = default;
};

/// From `from_s` on, until before `to_s`.
struct TimeSpan {
  double from_s = 0;
  double to_s = 0;
};

struct Imu {
  /// adis16448, tumvi, esim, ideal, or custom when a key overrides the preset.
  std::string preset = "adis16448";
  ImuNoise noise;
  double rate_hz = 200;
  std::vector<TimeSpan> gaps;  ///< without readings, in order; each from above 0
};

/// Wheel odometry: velocity of B in B, and yaw rate, at its own rate.
struct Odometry {
  bool enabled = false;
  double rate_hz = 50;
  double noise_mps = 0.01;        ///< white, per sample and axis
  double yaw_noise_radps = 0.05;  ///< white, per sample of the yaw rate: wheels 0.4 m apart
  double scale_error = 0.005;     ///< standard deviation of a scale drawn once a run
};

enum class EgoMotionSource {
  imu,    ///< strapdown integration of the simulated IMU (and odometry where enabled)
  truth,  ///< exact poses, for experiments that say so by name
};

/// What the camera makes of the scene: `sim/photograph.h` has the model. As it stands here it adds
/// a sensor's noise to the rendered picture, which shows a white surface in daylight as white;
/// without the noise it leaves it as it is.
struct Image {
  static constexpr double kDaylight_lx = 10000;  ///< an overcast day
  static constexpr double kDaylightExposure_s = 1e-3;

  struct Headlights {
    double intensity_cd = 0;                 ///< along the optical axis
    double beam_rad = std::numbers::pi / 9;  ///< standard deviation of the beam round it
  };
  struct Rain {
    double rate_mmph = 0;    ///< that falls, millimetres an hour
    int lens_drops = 0;      ///< on the window before the lens at any time
    double drop_life_s = 4;  ///< mean time until one runs off and another lands
  };
  struct Noise {
    double full_well_e = 10000;  ///< electrons of a pixel that is saturated
    double read_e = 5;           ///< standard deviation of what reading adds, electrons
  };

  double light_lx = kDaylight_lx;  ///< on the scene, the rover's own lights aside
  std::optional<Headlights> headlights;
  std::optional<double> visibility_m;  ///< at which contrast falls to 2 %; none: clear air
  std::optional<Rain> rain;
  double blur_px = 0;  ///< standard deviation, on top of the lens's own
  double exposure_s = kDaylightExposure_s;
  double gain = 1;
  std::optional<Noise> noise = Noise{};  ///< none: a sensor without any
  std::optional<int> jpeg_quality;       ///< 1 to 100, of what arrives; none: not compressed
};

/// Bumps on the floor that wheels feel and the camera sees: a Gaussian random field.
struct Ground {
  double roughness_m = 0.01;  ///< standard deviation of the height
  double wavelength_m = 0.6;  ///< of the shortest waves; the longest are three times as long
  std::optional<Eigen::Vector2d> centre_m;  ///< none: where the ego starts
  Eigen::Vector2d size_m{8, 4};             ///< along x and y; level at its edges
};

/// \name Trajectories of actors, on the ground plane. An actor heads the way that it moves.
///@{
struct Still {
  std::optional<Eigen::Vector2d> position_m;  ///< none: where the scene has the body
  std::optional<double> heading_rad;
};
struct Line {
  std::optional<Eigen::Vector2d> from_m;  ///< none: where the scene has the body
  std::optional<double> heading_rad;      ///< none: the heading that the scene gives the body
  double speed_mps = 0;                   ///< >= 0
  double acceleration_mps2 = 0;           ///< a speed that reaches 0 stays 0: "comes and parks"
};
struct Waypoints {
  /// At least two, straight and uniform in between; times count from the start trigger, and
  /// increase.
  std::vector<Waypoint> points;
};
struct Circular {
  Eigen::Vector2d centre_m = Eigen::Vector2d::Zero();
  double radius_m = 0;  ///< > 0
  double start_angle_rad = 0;
  double speed_mps = 0;  ///< > 0 is ccw
};
///@}
using Trajectory = std::variant<Still, Line, Waypoints, Circular>;

/// An actor waits at the first point of its trajectory until its trigger fires.
struct StartTrigger {
  double at_s = 0;                     ///< not before this time
  std::optional<double> ego_within_m;  ///< and not before the ego is as near as this
};

enum class Shape { box, cylinder, pedestrian, car, own };

struct Actor {
  std::string name;
  Source source;
  std::optional<std::string>
      body;  ///< moves this body of the scene; else an actor of `shape` is added
  Shape shape = Shape::box;
  std::filesystem::path shape_file;  ///< of `Shape::own`: MJCF, which exists
  std::optional<Eigen::Vector3d>
      size_m;           ///< length (x), width (y), height (z); none: the shape's own
  std::string texture;  ///< style of the procedural texture, or a PNG file; "": own
  Trajectory trajectory;
  StartTrigger start;
};

/// The names of the layouts that recordings have on disk (`tools/replay/recorded.h` reads them).
inline constexpr std::array<const char*, 8> kRecordingFormats{
    "euroc", "kitti", "kitti_odometry", "robotcar", "tum_rgbd", "mot", "video", "pictures"};

/// Frames that a camera took, in place of a simulation's. What is not given is as the layout says,
/// or not known; nothing is made up. The camera looks along its z, with x right and y down.
struct Recorded {
  /// As OpenCV has it. Both begin with the distortion along the radius.
  struct Distortion {
    bool equidistant = false;          ///< else radial and tangential
    std::vector<double> coefficients;  ///< k1 k2 p1 p2 k3, or of `equidistant` k1 k2 k3 k4
  };
  enum class Split { train, validate, test };

  Source source;
  std::filesystem::path path;  ///< a folder, or a video file; exists
  std::string format;          ///< of `kRecordingFormats`; "": told from what is there
  std::string camera;          ///< which of several; "": the layout's first
  std::optional<double> fps;   ///< pictures a second
  int every = 1;               ///< of the pictures each n-th is a frame, from the first one on
  /// \name How the camera moved, each a file that exists. @{
  std::optional<std::filesystem::path> poses;     ///< T_WC: lines of TUM, or of KITTI odometry
  std::optional<std::filesystem::path> imu;       ///< columns as EuRoC has them
  std::optional<std::filesystem::path> odometry;  ///< likewise, of a velocity; with an IMU
  std::optional<double> speed_mps;                ///< along the optical axis; 0: it stands
  ///@}
  std::optional<double> focal_px;
  std::optional<Eigen::Vector2d> centre_px;
  std::optional<Distortion> distortion;
  std::optional<double> camera_height_m;         ///< above the ground
  std::optional<Eigen::Vector3d> mount_rpy_rad;  ///< as `Camera::mount_rpy_rad`
  std::optional<std::filesystem::path> mask;     ///< a picture: white is the vehicle itself
  std::optional<double> at_rest_s;               ///< from the start on it stands for as long
  std::optional<std::filesystem::path> labels;   ///< boxes of what moves
  bool nothing_moves = false;
  std::optional<Split> split;  ///< what figures of it are for
};

/// Settings for the filter in the filter's own words; the scenario only carries them.
struct FilterSetting {
  std::string key;    ///< as in "circle.mu_0"
  std::string value;  ///< as written
  Source source;
};

/// A bound on a metric of the run; a failed required one makes the command exit with 1.
struct Criterion {
  std::string metric;  ///< a key of metrics.json
  std::optional<double> min;
  std::optional<double> max;
  bool required = true;
  Source source;
  std::string detector = {};  ///< that is asked, by its name in a run; "": the run's own
};

/// A key that a sweep gives several values; each is YAML text, fit for `--set`.
struct SweptKey {
  struct Value {
    std::string text;
    Source source;
  };
  std::string key;  ///< as in "ego.speed"
  std::vector<Value> values;
  Source source;
};

/// The world that a scene was drawn as (`lcs world`). It stays the same world under another name,
/// with another seed, in another scenario and as a sequence of pictures.
struct Origin {
  Source source = {};
  std::string family = {};  ///< "room"
  std::uint64_t seed = 0;   ///< that the world was drawn from; a run may have another
  std::uint64_t again = 0;  ///< worlds of this seed that were thrown away before this one
  std::vector<std::string> features = {};  ///< that occur in it

  bool is_same_world(const Origin& other) const {
    return family == other.family && seed == other.seed;
  }
};
/// The name of the text by which a scene states its origin, as in MJCF's
/// `<custom><text name="lcs.world" data="room 7"/></custom>`.
inline constexpr const char* kOriginText = "lcs.world";

inline constexpr int kFastThreshold = 20;

struct Scenario {
  std::string name;  ///< the file's stem
  std::filesystem::path file;
  std::string purpose;                          ///< one line
  std::vector<std::string> groups = {"short"};  ///< that it belongs to, at least one
  /// Takes the place of `scene`, `ego`, `camera`, `imu`, `odometry`, `image`, `ground` and
  /// `actors`, which then keep their defaults.
  std::optional<Recorded> recording;
  std::filesystem::path scene;  ///< the MJCF file, which exists
  Source scene_source;
  std::optional<Origin> origin;  ///< as the file states it; the scene may state one as well
  std::uint64_t seed = 1;        ///< textures, IMU noise, odometry; independent streams by name
  int frames = 0;                ///< > 0; of a recording at the most, and 0 for all that it has
  Ego ego;
  Camera camera;
  Imu imu;
  Odometry odometry;
  EgoMotionSource ego_motion = EgoMotionSource::imu;
  /// Threshold of FAST, 1 to 254 grey levels; none: chosen in each picture (`threshold: auto`).
  std::optional<int> fast_threshold = kFastThreshold;
  double truth_min_depth_m = 0.5;  ///< nearest depth of the static segment (`radial`)
  Image image;
  std::optional<Ground> ground;  ///< none: as level as the scene has it
  std::vector<Actor> actors;
  std::string filter_preset;  ///< "" is the filter's default
  Source filter_preset_source;
  std::vector<FilterSetting> filter;
  std::vector<Criterion> criteria;
  /// What the sensors' data and the truth depend on, the seed apart, as it is written:
  /// {"ego.speed", "0.5 m/s"}. How a run is watched and judged is not in it.
  std::map<std::string, std::string> world;
  /// A run of the scenario itself leaves these as the file has them outside of `sweep`; see
  /// `scenarios/sweep.h`.
  std::vector<SweptKey> sweep;
};

}  // namespace lcs::scenario
