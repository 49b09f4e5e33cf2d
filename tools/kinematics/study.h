/// \file
/// All experiments on one camera, rover and IMU, which are taken from a scenario.
#pragma once

#include <Eigen/Core>
#include <functional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "filter/kinematics/geometry.h"
#include "filter/paper/any_filter.h"
#include "scenarios/scenario.h"
#include "sim/drive.h"
#include "tools/kinematics/points.h"

namespace lcs::kinematics {

/// Size of the experiments that take long. All others do not depend on it.
struct Effort {
  int drive_frames = 40;  ///< of each rendered drive
  int noise_seeds = 20;   ///< of each IMU at each frame rate
  int drift_seeds = 300;  ///< of each IMU
  double drift_s = 60;
  static Effort full() { return {}; }
  static Effort quick() { return {.drive_frames = 15, .noise_seeds = 5, .drift_seeds = 25}; }
};

struct StudyConfig {
  scenario::Scenario
      scenario;  ///< without the lens: its camera is the pinhole that the filter gets
  sim::Lens lens;
  AnyParameters filter;
  Effort effort;
  /// Nominal speed: the fastest commanded at the start of a phase of the scenario.
  double speed_mps = 0;
  double tolerance_px = 1;  ///< bound of an end-point error in the verdicts
  bool stands = false;      ///< the scenario's rover never moves, so the speed is a substitute
  Eigen::Vector3d forward_C = Eigen::Vector3d::UnitZ();  ///< the rover's x in the camera
  sim::Pinhole camera;

  double frame_s() const { return 1 / scenario.camera.rate_hz; }
  /// Distance that the camera travels in a frame, straight ahead.
  Eigen::Vector3d step_C_m() const { return speed_mps * frame_s() * forward_C; }
};

/// \throws input::Error for an invalid filter setting.
StudyConfig configure(const scenario::Scenario& scenario, const Effort& effort);

/// \name Scenarios made from the configured one.
///@{
/// The holonomic rover drives straight ahead at nominal speed, with ideal sensors and no actors.
scenario::Scenario straight_drive(const StudyConfig& config, double duration_s, double rate_hz);
/// The same on a curve of `yaw_rate_radps`.
scenario::Scenario curved_drive(const StudyConfig& config, double duration_s, double rate_hz,
                                double yaw_rate_radps);
/// The same on wheels, over bumps of this roughness; 0 is level ground.
scenario::Scenario bumpy_drive(const StudyConfig& config, double duration_s, double rate_hz,
                               double roughness_m);
///@}

/// The readings of a drive with ideal sensors, with noise added.
sim::Drive with_noise(const sim::Drive& ideal, const scenario::Scenario& noisy);

// ---- The rows of an experiment, as in its CSV file

/// A word, or a figure; NaN if it is unknown.
using Cell = std::variant<std::string, double>;

class Table {
 public:
  /// \param columns with commas between them.
  explicit Table(const std::string& columns);

  /// Adds a row. \param values of its columns, in order; a model, a summary and an array fill some
  ///   columns each.
  template <class... Values>
  void add(const Values&... values) {
    rows_.emplace_back();
    (put(values), ...);
  }

  /// The figures of a column, of the rows in which other columns have these values.
  using Where = std::vector<std::pair<const char*, Cell>>;
  std::vector<double> figures(const char* column, const Where& where = {}) const;
  /// The first of them. \throws std::logic_error if there is none.
  double figure(const char* column, const Where& where) const;

  /// Comma-separated text without quotes, which no cell needs. Numbers have six significant digits;
  /// unknown ones, and the errors of no points, are empty cells.
  std::string csv() const;

 private:
  std::size_t place_of(const char* column) const;
  void put(const Cell& cell) { rows_.back().push_back(cell); }
  void put(DepthSource depth) { put(name(depth)); }
  void put(const FieldModel& model);
  void put(const double (&three)[3]);
  void put(const ErrorSummary& errors);

  std::vector<std::string> columns_;
  std::vector<std::vector<Cell>> rows_;
};

using Tick = std::function<void(int)>;  ///< called with the number of pieces of work just done

// ---- The four drives: as configured, straight ahead, turning by `kTurning_deg` a frame, over
// bumps. Sensors are as configured.

inline constexpr double kTurning_deg = 1;
struct NamedDrive {
  std::string name;  ///< "configured", "straight", "turning", "bumps"
  scenario::Scenario scenario;
};
std::vector<NamedDrive> drives(const StudyConfig& config);

struct DriveResult {
  double turn_max_rad = 0;             ///< the camera's largest true turn from a frame to the next
  std::vector<PointSet> still_frames;  ///< some of the frames, for the geometric experiments
};

/// Landmarks are the filter's normal edges on fixed objects with a corner in the frame. The
/// filter's motion comes from the scenario's own sensors.
/// \param rows as `Study::drives`.
DriveResult rendered_drive(const StudyConfig& config, const NamedDrive& drive, Table& rows,
                           const Tick& tick);

/// The first frame of the configured scenario with another lens.
PointSet rendered_with_lens(const StudyConfig& config, double fovy_rad);

// ---- Purely geometric experiments: every model's end-point error after one camera step of known
// size, over points with known truth. There is no sensor noise, and the models are given the exact
// motion, except for the mounting error. Each adds its rows to the table of its name in `Study`.

/// "tilt" (about x), "pan" (about y), "roll" (about z).
const char* axis_name(int axis);

/// Turns in a frame, in both directions.
void sweep_rotation(const StudyConfig& config, const std::vector<PointSet>& points, Table& rows);

/// Turn in a frame, rad, up to which a rotation model errs by at most `bound_px` on all points that
/// stay in the image. NaN if it never errs more, up to `kLargestTurn_rad` or until no point is
/// left.
inline constexpr double kLargestTurn_rad = 0.5;
/// \param told_sign -1: the rate is given with the other sign, in case the model means other axes.
double rotation_limit_rad(const PointSet& points, const FieldParameters& field,
                          RotationModel rotation, int axis, double bound_px, double told_sign = 1);

/// Driving straight ahead by speed / frame rate in a frame, towards points of one depth.
void sweep_translation(const StudyConfig& config, const std::vector<PointSet>& rendered,
                       Table& rows);

/// The nominal step and a turn of `kFoePan_deg`, by the points' distance from the focus of
/// expansion.
inline constexpr double kFoePan_deg = 1;
void sweep_foe_distance(const StudyConfig& config, const std::vector<PointSet>& points,
                        Table& rows);

/// The nominal step, with the camera mounted differently from the filter's calibration.
inline constexpr double kMountPan_deg = 1;
void sweep_mount(const StudyConfig& config, const std::vector<PointSet>& points, Table& rows);

/// The motion in the axes of an estimator whose camera axes are C' = C turned by `R_CM`.
EgoMotion seen_by_wrong_mount(const EgoMotion& motion, const Eigen::Matrix3d& R_CM);

/// The same scene through another lens.
void add_focal_length(const StudyConfig& config, const PointSet& points, double fovy_deg,
                      Table& rows);

// ---- Errors caused by the sensors: end-point errors of the exact model (homography, true depth)
// with motion from a noisy IMU, and of all rotation models with wheels on bumps. Poses and readings
// come from MuJoCo; points are geometric.

/// An IMU under test, by its name.
struct NamedImu {
  std::string name;
  scenario::ImuNoise noise;
};
/// The scenario's own IMU first, then the other presets.
std::vector<NamedImu> imus(const StudyConfig& config);

inline constexpr double kImuDrive_s = 10;  ///< from a known start

void add_imu_rows(const StudyConfig& config, Table& rows, const Tick& tick);
void add_bump_rows(const StudyConfig& config, Table& rows, const Tick& tick);

/// Dead reckoning without pictures: the drift of attitude and velocity on a straight drive from a
/// known start, with and without odometry, beside the theoretical drift. One row for each second.
void add_drift_rows(const StudyConfig& config, Table& rows, const Tick& tick);

/// Pieces of work of these three, for `tick`.
int sensor_pieces(const StudyConfig& config);

// ---- The error of a prediction that leaves out the distortion, the rolling shutter or the time
// offset of the camera, at the motions of the configured drive.

/// The 95th percentile of the errors over frames and geometric points, px.
struct LeftOut {
  double distortion_px = 0;  ///< of the motion from frame to frame; 0 for a pinhole
  double readout_s = 0;      ///< the scenario's, or else `kReadout_s`
  double readout_px = 0;     ///< of the last row, which is seen that much later than the first
  double offset_s = 0;       ///< of the clocks, as told to the filter, or else `kOffset_s`
  double offset_px = 0;      ///< of the motion from frame to frame, over the shifted interval
  /// \name By the first-order motion field, in place of the exact motion.
  ///@{
  double expected_readout_px = 0;
  double expected_offset_px = 0;
  ///@}
};

inline constexpr double kReadout_s = 0.02;
inline constexpr double kOffset_s = 0.005;

/// \throws input::Error, sim::PhysicsError
LeftOut left_out(const StudyConfig& config);

// ---- The study

/// Figures end in their units. An axis is of `axis_name`; `points` are "geometric" or "rendered".
struct Study {
  /// The columns of an `ErrorSummary`.
  static inline const std::string kErrors = ",points_seen,median_px,p95_px,max_px,rms_px";

  StudyConfig config;
  Table rotation{"points,axis,angle_deg,step_m,rotation,depth" +
                 kErrors};  ///< step_m 0: only turns
  /// depth_m: median for rendered points.
  Table translation{"points,speed_mps,rate_hz,depth_m,step_over_depth,depth" + kErrors};
  Table foe{"points,from_px,to_px,rotation,depth" + kErrors};
  /// axis: of the camera, of the mounting error; pan_deg: turn of the camera in the frame; errors
  /// of the exact model with the true depth.
  Table mount{"points,axis,error_deg,pan_deg,foe_shift_px" + kErrors};
  /// Largest turns within the tolerance about each axis: of first order, the same by
  /// `first_order_limit_rad`, of the printed rotation; median errors at the nominal step.
  Table focal{
      "points,fovy_deg,focal_px,first_order_limit_tilt_deg,first_order_limit_pan_deg,"
      "first_order_limit_roll_deg,theory_limit_tilt_deg,theory_limit_pan_deg,"
      "theory_limit_roll_deg,as_printed_limit_tilt_deg,as_printed_limit_pan_deg,"
      "as_printed_limit_roll_deg,reference_median_px,learnt_median_px"};
  /// told_by: source of the motion, "truth", or "imu" as configured; expected_median_px: for the
  /// reference depth with true motion V_v t_f |Z_ref / Z - 1|, unknown for others.
  Table drives{"drive,told_by,rotation,depth,expected_median_px" + kErrors};
  /// rate_hz: of the camera; errors over all frames and seeds; rotation_rms_px: with the true
  /// velocity; expected by `theory.h`.
  Table imu{"imu,rate_hz,odometry,seeds,expected_rms_px,rotation_rms_px,expected_rotation_rms_px" +
            kErrors};
  /// Turns of the camera in a frame; rotation: the model's name, or "none", where no rotation is
  /// compensated; told_by: "truth" or "imu"; errors with the true depth. expected_rms_px: for
  /// "none" the first order of the turns, for first order the second; unknown for others.
  Table bumps{
      "roughness_m,turn_median_deg,turn_p95_deg,turn_max_deg,rotation,told_by,expected_rms_px" +
      kErrors};
  /// Root mean square errors over the seeds after t_s: of attitude about each horizontal axis and
  /// about the vertical, and of velocity in the rover's frame; expected by `theory.h`, with
  /// odometry for a settled filter.
  Table drift{
      "imu,odometry,t_s,seeds,tilt_rad,heading_rad,forward_mps,lateral_mps,vertical_mps,"
      "expected_tilt_rad,expected_heading_rad,expected_forward_mps,expected_lateral_mps,"
      "expected_vertical_mps"};
  LeftOut left_out;
  double turn_max_rad = 0;  ///< of the configured drive, as of `DriveResult`
};

/// Depths of the sweeps' geometric points, which cover the whole image.
PointSet study_points(const sim::Pinhole& camera);

/// Number of pieces of work in a study.
int study_pieces(const StudyConfig& config);

/// Deterministic: equal configurations give equal bits with any number of cores.
/// \param tick called from this thread with the number of pieces just done; its exceptions end the
///   study.
/// \throws input::Error, sim::PhysicsError, std::runtime_error
Study carry_out(const StudyConfig& config, const Tick& tick);

}  // namespace lcs::kinematics
