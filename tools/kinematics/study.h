/// \file
/// All experiments on one camera, rover and IMU.
#pragma once

#include <functional>
#include <vector>

#include "tools/kinematics/points.h"
#include "tools/kinematics/study_config.h"

namespace lcs::kinematics {

using Tick = std::function<void(int)>;  ///< called with the number of pieces of work just done

struct DriveRow {
  std::string drive;  ///< "configured", "straight", "turning", "bumps"
  std::string told;   ///< source of the motion: "truth", or "imu" as configured
  FieldModel model;
  ErrorSummary error;
  /// For the reference depth with true motion: V_v t_f |Z_ref / Z - 1|; NaN for others.
  double expected_median_px = 0;
  double turn_max_rad = 0;  ///< the camera's largest true turn from a frame to the next
};

struct DriveResult {
  std::vector<DriveRow> rows;
  std::vector<PointSet> still_frames;  ///< some of the frames, for the geometric experiments
};

/// Landmarks are the filter's normal edges on fixed objects with a corner in the frame. The
/// filter's motion comes from the scenario's own sensors.
DriveResult rendered_drive(const StudyConfig& config, const std::string& name,
                           const scenario::Scenario& scenario, const Tick& tick);

/// The four drives: as configured, straight ahead, turning by `kTurning_deg` a frame, over bumps.
/// Sensors are as configured.
inline constexpr double kTurning_deg = 1;
struct NamedDrive {
  std::string name;
  scenario::Scenario scenario;
};
std::vector<NamedDrive> drives(const StudyConfig& config);

/// The first frame of the configured scenario with another lens.
PointSet rendered_with_lens(const StudyConfig& config, double fovy_rad);

// ---- Purely geometric experiments: every model's end-point error after one camera step of known
// size, over points with known truth. There is no sensor noise, and the models are given the exact
// motion, except for the mounting error.

/// "tilt" (about x), "pan" (about y), "roll" (about z).
std::string_view axis_name(int axis);

/// Turns by `angle_deg` in a frame, in both directions.
struct RotationRow {
  std::string points;
  int axis = 0;
  double angle_deg = 0;
  double step_m = 0;  ///< forward motion of the camera; 0: it only turns
  FieldModel model;
  ErrorSummary error;
};
std::vector<RotationRow> sweep_rotation(const StudyConfig& config,
                                        const std::vector<PointSet>& points);

/// Turn in a frame, rad, up to which a rotation model errs by at most `bound_px` on all points that
/// stay in the image. NaN if it never errs more, up to `kLargestTurn_rad` or until no point is
/// left.
inline constexpr double kLargestTurn_rad = 0.5;
/// \param told_sign -1: the rate is given with the other sign, in case the model means other axes.
double rotation_limit_rad(const PointSet& points, const FieldParameters& field,
                          RotationModel rotation, int axis, double bound_px, double told_sign = 1);

/// Driving straight ahead by speed / frame rate in a frame, towards points of one depth.
struct TranslationRow {
  std::string points;
  double speed_mps = 0;
  double rate_hz = 0;
  double depth_m = 0;          ///< median for rendered points
  double step_over_depth = 0;  ///< speed / rate / depth
  DepthSource depth = DepthSource::truth;
  ErrorSummary error;
};
std::vector<TranslationRow> sweep_translation(const StudyConfig& config,
                                              const std::vector<PointSet>& rendered);

/// The nominal step and a turn of `kFoePan_deg`, by the points' distance from the focus of
/// expansion.
inline constexpr double kFoePan_deg = 1;
struct FoeRow {
  std::string points;
  double from_px = 0, to_px = 0;
  FieldModel model;
  ErrorSummary error;
};
std::vector<FoeRow> sweep_foe_distance(const StudyConfig& config,
                                       const std::vector<PointSet>& points);

/// The nominal step, with the camera mounted differently from the filter's calibration.
struct MountRow {
  std::string points;
  int axis = 0;  ///< camera axis of the mounting error
  double error_deg = 0;
  double pan_deg = 0;  ///< turn of the camera in the frame
  double foe_shift_px = 0;
  ErrorSummary error;  ///< of the exact model with the true depth
};
inline constexpr double kMountPan_deg = 1;
std::vector<MountRow> sweep_mount(const StudyConfig& config, const std::vector<PointSet>& points);

/// The motion in the axes of an estimator whose camera axes are C' = C turned by `R_CM`.
EgoMotion seen_by_wrong_mount(const EgoMotion& motion, const Eigen::Matrix3d& R_CM);

/// The same scene through other lenses.
struct FocalRow {
  std::string points;
  double fovy_deg = 0;
  double focal_px = 0;
  double limit_deg[3] = {};        ///< of first order, to the tolerance, about each axis
  double theory_deg[3] = {};       ///< the same by `first_order_limit_rad`
  double printed_deg[3] = {};      ///< of the printed rotation
  double reference_median_px = 0;  ///< at the nominal step
  double learnt_median_px = 0;
};
FocalRow focal_row(const StudyConfig& config, const PointSet& points, double fovy_deg);

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

struct ImuRow {
  std::string imu;
  double rate_hz = 0;  ///< of the camera
  bool odometry = false;
  int seeds = 0;
  ErrorSummary error;           ///< over all frames and seeds
  ErrorSummary rotation_error;  ///< as `error`, with the true velocity
  double expected_rms_px = 0;   ///< by `theory.h`
  double expected_rotation_rms_px = 0;
};
std::vector<ImuRow> imu_rows(const StudyConfig& config, const Tick& tick);
int imu_pieces(const StudyConfig& config);  ///< of work, for `tick`

struct BumpRow {
  double roughness_m = 0;
  double turn_median_deg = 0, turn_p95_deg = 0, turn_max_deg = 0;  ///< of the camera in a frame
  std::string rotation;  ///< the model's name, or "none": no rotation is compensated
  std::string told;      ///< "truth" or "imu"
  ErrorSummary error;    ///< with the true depth
  /// For "none" the first order of the turns, for first order the second; NaN for others.
  double expected_rms_px = 0;
};
std::vector<BumpRow> bump_rows(const StudyConfig& config, const Tick& tick);
int bump_pieces();

// ---- Dead reckoning without pictures: the drift of attitude and velocity on a straight drive from
// a known start, with and without odometry, beside the theoretical drift.

/// Root mean square errors of attitude, and of velocity in the rover's frame.
struct DriftErrors {
  double tilt_rad = 0;                                       ///< about each horizontal axis
  double heading_rad = 0;                                    ///< about the vertical
  Eigen::Vector3d velocity_B_mps = Eigen::Vector3d::Zero();  ///< forward, lateral, vertical
};

struct DriftRow {
  std::string imu;
  bool odometry = false;
  double t_s = 0;
  int seeds = 0;
  DriftErrors rms;       ///< over the seeds, after `t_s`
  DriftErrors expected;  ///< by `theory.h`; with odometry for a settled filter
};

/// One row for each second.
std::vector<DriftRow> drift_rows(const StudyConfig& config, const Tick& tick);
int drift_pieces(const StudyConfig& config);

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

struct Study {
  StudyConfig config;
  std::vector<RotationRow> rotation;
  std::vector<TranslationRow> translation;
  std::vector<FoeRow> foe;
  std::vector<MountRow> mount;
  std::vector<FocalRow> focal;
  std::vector<DriveRow> drives;
  std::vector<ImuRow> imu;
  std::vector<BumpRow> bumps;
  std::vector<DriftRow> drift;
  LeftOut left_out;
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
