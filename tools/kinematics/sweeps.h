/// \file
/// The experiments of geometry alone: every model's end-point error after one step of the camera,
/// of known size, over points of known truth. There is no sensor noise, and the models are told the
/// exact motion, but for the error of the mount.
#pragma once

#include <vector>

#include "tools/kinematics/points.h"
#include "tools/kinematics/study_config.h"

namespace lcs::kinematics {

/// "tilt" (about x), "pan" (about y), "roll" (about z).
std::string_view axis_name(int axis);

/// Turning by `angle_deg` in a frame, to both sides.
struct RotationRow {
  std::string points;
  int axis = 0;
  double angle_deg = 0;
  double step_m = 0;  ///< that the camera moves forwards too; 0: it only turns
  Model model;
  ErrorSummary error;
};
std::vector<RotationRow> sweep_rotation(const StudyConfig& config,
                                        const std::vector<PointSet>& points);

/// Turn in a frame, rad, up to which a rotation model errs by no more than `bound_px` on all points
/// that stay in the image; NaN for a model that never does more, up to `kLargestTurn_rad` or to
/// where no point is left.
inline constexpr double kLargestTurn_rad = 0.5;
/// \param told_sign -1: the rate is told with the other sign, in case the model means other axes.
double rotation_limit_rad(const PointSet& points, const FieldParameters& field,
                          RotationModel rotation, int axis, double bound_px, double told_sign = 1);

/// Driving straight on, by speed / frame rate in a frame, towards points of one depth.
struct TranslationRow {
  std::string points;
  double speed_mps = 0;
  double rate_hz = 0;
  double depth_m = 0;          ///< of rendered ones the median
  double step_over_depth = 0;  ///< speed / rate / depth
  DepthSource depth = DepthSource::truth;
  ErrorSummary error;
};
std::vector<TranslationRow> sweep_translation(const StudyConfig& config,
                                              const std::vector<PointSet>& rendered);

/// The nominal step and a turn of `kFoePan_deg`, by the distance of the points from the focus of
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

/// The nominal step, with the camera mounted otherwise than the filter was told.
struct MountRow {
  std::string points;
  int axis = 0;  ///< of the camera, that it is turned about
  double error_deg = 0;
  double pan_deg = 0;  ///< that the camera turns in the frame
  double foe_shift_px = 0;
  ErrorSummary error;  ///< of the exact model with the true depth
};
inline constexpr double kMountPan_deg = 1;
std::vector<MountRow> sweep_mount(const StudyConfig& config, const std::vector<PointSet>& points);

/// The motion as an estimator states it that takes the camera's axes for C' = C turned by `R_CM`.
EgoMotion seen_by_wrong_mount(const EgoMotion& motion, const Eigen::Matrix3d& R_CM);

/// The same image behind other lenses.
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
