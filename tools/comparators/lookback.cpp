#include "tools/comparators/lookback.h"

#include "filter/kinematics/rotation.h"

namespace lcs::comparators {

EgoMotion composed(const EgoMotion& earlier, const EgoMotion& later) {
  EgoMotion motion;
  motion.dt_s = earlier.dt_s + later.dt_s;
  motion.R_cur_prev = later.R_cur_prev * earlier.R_cur_prev;
  if (motion.dt_s > 0) {
    const Eigen::Vector3d displacement_C_m =
        later.R_cur_prev * earlier.v_C_mps * earlier.dt_s + later.v_C_mps * later.dt_s;
    motion.v_C_mps = displacement_C_m / motion.dt_s;
    motion.w_C_radps = -logarithm(motion.R_cur_prev) / motion.dt_s;
  }
  motion.unseen_turn_rad = std::hypot(earlier.unseen_turn_rad, later.unseen_turn_rad);
  motion.velocity_sigma_mps = later.velocity_sigma_mps;
  motion.ground = later.ground;
  return motion;
}

}  // namespace lcs::comparators
