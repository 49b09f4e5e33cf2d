/// \file
/// Purely geometric experiments: every model's end-point error after one camera step of known size,
/// over points with known truth. There is no sensor noise, and the models are given the exact
/// motion, except for the mounting error.
#pragma once

#include <vector>

#include "tools/kinematics/points.h"
#include "tools/kinematics/study_config.h"

namespace lcs::kinematics {

/// "tilt" (about x), "pan" (about y), "roll" (about z).
std::string_view axis_name(int axis);

/// Turns by `angle_deg` in a frame, in both directions.
struct RotationRow {
  std::string points;
  int axis = 0;
  double angle_deg = 0;
  double step_m = 0;  ///< forward motion of the camera; 0: it only turns
  Model model;
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
  Model model;
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

}  // namespace lcs::kinematics
