/// \file
/// The gait of a walker: the angles of its limbs by the way that it has walked.
///
/// A stride has the length S = `kStride` L, with L the leg's length from hip to ankle at rest. The
/// phase of the left leg is the walked way in strides; the right leg is half a stride ahead.
/// During the first `kStance` of its stride a foot is planted: it is at rest on the ground, while
/// the body goes on. During the rest it swings ahead by S on a cycloid, which begins and ends at
/// rest, and is lifted by up to `kLift` L. Hip and knee follow from hip and ankle as the two sides
/// and the angle of a triangle; the ankle keeps the foot level. The trunk is lowered, by 11 % of L
/// when both feet are planted and by 3 % when a leg passes the other. An arm swings with the
/// opposite leg.
///
/// On a straight way, at any speed and acceleration, a planted foot does not move. On a circle of
/// radius R, which bends below it, its ankle slides by up to `kStance` S / (2 R) of the speed.
#pragma once

#include <array>

#include "sim/scene/model.h"

namespace lcs::sim {

class Gait {
 public:
  static constexpr double kStride = 1.3, kStance = 0.6, kLift = 0.15;
  /// The bodies of a walker below `base`, in MuJoCo's names: trunk, then the limbs of each side.
  static constexpr const char* kTrunk = "trunk";
  static constexpr std::array kSides{"left_", "right_"};
  static constexpr std::array kLeg{"thigh", "shank", "foot"};
  static constexpr std::array kArm{"upper_arm", "forearm"};

  /// \param prefix of the names of its bodies, which are at rest: upright, with straight limbs.
  Gait(const Model& model, const std::string& prefix);

  double stride_m() const { return kStride * leg_m(); }
  /// Places the limbs, in the model: their poses in their parents.
  void place(mjModel& m, double walked_m) const;

 private:
  struct Leg {
    std::array<int, 3> bodies;
    double thigh_m, shank_m;
  };
  double leg_m() const { return legs_[0].thigh_m + legs_[0].shank_m; }

  int trunk_;
  double trunk_m_;  ///< height of the trunk's origin at rest
  std::array<Leg, 2> legs_;
  std::array<std::array<int, 2>, 2> arms_;
};

}  // namespace lcs::sim
