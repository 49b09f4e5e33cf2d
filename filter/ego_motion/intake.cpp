#include "filter/ego_motion/intake.h"

#include <Eigen/LU>
#include <cmath>

namespace lcs {
namespace {

/// Shorter steps count as zero time: speeds would be rounding errors.
constexpr double kShortestStep_s = 1e-6;

constexpr double kMostTurn_radps = 1000;
/// As a standard deviation it says already that nothing is known.
constexpr double kMostTurn_rad = 1000;

/// Tolerance of R R^T: 0.4 px at the border of a 640 px picture of 75 deg.
constexpr double kOffRotation = 1e-3;

/// m: outside of this range the ground is not used.
constexpr double kLeastHeight_m = 1e-3, kMostHeight_m = 1e4;

std::optional<Fault> fault_of(const EgoMotion& m) {
  if (!std::isfinite(m.dt_s) || !m.R_cur_prev.allFinite() || !m.v_C_mps.allFinite() ||
      !m.w_C_radps.allFinite() || !(m.unseen_turn_rad >= 0 && m.velocity_sigma_mps >= 0) ||
      !std::isfinite(m.unseen_turn_rad) || !std::isfinite(m.velocity_sigma_mps)) {
    return Fault::motion_not_finite;
  }
  if (m.dt_s < 0) return Fault::time_back;
  if (m.dt_s > kLongestStep_s) return Fault::time_jump;
  if (!(m.v_C_mps.norm() <= kMostSpeed_mps && m.w_C_radps.norm() <= kMostTurn_radps &&
        m.velocity_sigma_mps <= kMostSpeed_mps && m.unseen_turn_rad <= kMostTurn_rad)) {
    return Fault::motion_too_fast;
  }
  if (!is_rotation(m.R_cur_prev)) return Fault::motion_no_rotation;
  return std::nullopt;
}

bool is_ground(const Ground& ground) {
  return std::abs(ground.up_C.norm() - 1) < kOffRotation && ground.height_m >= kLeastHeight_m &&
         ground.height_m <= kMostHeight_m;
}

}  // namespace

bool is_rotation(const Eigen::Matrix3d& R) {
  const Eigen::Matrix3d off = R * R.transpose() - Eigen::Matrix3d::Identity();
  return (off.array().abs() < kOffRotation).all() && R.determinant() > 0;
}

std::optional<EgoMotion> Intake::take(const EgoMotion& told, Diagnostics& diagnostics) {
  const bool is_first = is_first_;
  is_first_ = false;
  if (const std::optional<Fault> fault = fault_of(told)) {
    diagnostics.add(*fault);
    return std::nullopt;
  }
  EgoMotion motion = told;
  if (motion.dt_s < kShortestStep_s) {
    motion.dt_s = 0;
    if (!is_first) diagnostics.add(Fault::time_still);
  }
  if (motion.ground && !is_ground(*motion.ground)) {
    diagnostics.add(Fault::ground_unusable);
    motion.ground.reset();
  }
  return motion;
}

}  // namespace lcs
