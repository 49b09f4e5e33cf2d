#include "sim/scene/gait.h"

#include <algorithm>
#include <cmath>

namespace lcs::sim {
namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLowered = 0.07, kBob = 0.04;  // of the trunk, in leg lengths
constexpr double kShoulder_rad = 0.45, kElbow_rad = 0.35, kElbowSwing_rad = 0.2;

/// The ankle of a leg in the body's frame, without the height of the ankle at rest. In strides.
struct Step {
  double ahead, up;
};

Step step_at(double phase) {
  constexpr double kHalf = Gait::kStance / 2;
  if (phase < Gait::kStance) return {kHalf - phase, 0};
  const double u = (phase - Gait::kStance) / (1 - Gait::kStance);
  const double on_ground = u - std::sin(kTurn * u) / kTurn;
  return {on_ground - (1 - Gait::kStance) * u - kHalf,
          Gait::kLift / Gait::kStride * (1 - std::cos(kTurn * u)) / 2};
}

/// \param ahead_rad angle of a limb that hangs, positive ahead.
void swing(mjModel& m, int body, double ahead_rad) {
  mjtNum* const q = m.body_quat + 4 * body;
  q[0] = std::cos(ahead_rad / 2);
  q[1] = q[3] = 0;
  q[2] = -std::sin(ahead_rad / 2);
}

}  // namespace

Gait::Gait(const Model& model, const std::string& prefix) {
  const auto body = [&](const std::string& name) { return model.id(mjOBJ_BODY, prefix + name); };
  const auto length_m = [&](int to) {
    const mjtNum* p = model.m().body_pos + 3 * to;
    return std::abs(p[2]);
  };
  trunk_ = body(kTrunk);
  trunk_m_ = model.m().body_pos[3 * trunk_ + 2];
  for (std::size_t side = 0; side < 2; ++side) {
    Leg& leg = legs_[side];
    for (std::size_t i = 0; i < 3; ++i) leg.bodies[i] = body(std::string(kSides[side]) + kLeg[i]);
    leg.thigh_m = length_m(leg.bodies[1]);
    leg.shank_m = length_m(leg.bodies[2]);
    for (std::size_t i = 0; i < 2; ++i) arms_[side][i] = body(std::string(kSides[side]) + kArm[i]);
  }
}

void Gait::place(mjModel& m, double walked_m) const {
  const double strides = walked_m / stride_m();
  // lowest in the middle of the time in which both feet are planted
  const double both = (kStance - 0.5) / 2;
  const double lower_m = leg_m() * (kLowered + kBob * std::cos(2 * kTurn * (strides - both)));
  m.body_pos[3 * trunk_ + 2] = trunk_m_ - lower_m;
  for (std::size_t side = 0; side < 2; ++side) {
    const Leg& leg = legs_[side];
    const double own = strides + (side == 0 ? 0 : 0.5), phase = own - std::floor(own);
    const Step step = step_at(phase);
    const double ahead_m = stride_m() * step.ahead;
    const double down_m = leg_m() - lower_m - stride_m() * step.up;
    const double a = leg.thigh_m, b = leg.shank_m;
    const double d2 = ahead_m * ahead_m + down_m * down_m;
    const double knee = std::acos(std::clamp((d2 - a * a - b * b) / (2 * a * b), -1.0, 1.0));
    const double thigh =
        std::atan2(ahead_m, down_m) + std::atan2(b * std::sin(knee), a + b * std::cos(knee));
    swing(m, leg.bodies[0], thigh);
    swing(m, leg.bodies[1], -knee);
    swing(m, leg.bodies[2], knee - thigh);
    const double arm = -std::cos(kTurn * phase);
    swing(m, arms_[side][0], kShoulder_rad * arm);
    swing(m, arms_[side][1], kElbow_rad + kElbowSwing_rad * arm);
  }
}

}  // namespace lcs::sim
