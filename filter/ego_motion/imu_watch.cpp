#include "filter/ego_motion/imu_watch.h"

#include <algorithm>
#include <cmath>

namespace lcs {
namespace {

/// Coarse quantisation may repeat a reading by chance, but not on all six axes this many times.
constexpr int kFrozen = 10;

/// A saturated axis repeats its largest magnitude this many times. No sensor's range ends
/// below these limits.
constexpr int kSaturated = 5;
constexpr double kLeastRange_radps = 1.5, kLeastRange_g = 1.5;

/// m/s^2: below this gravity, readings in g and in m/s^2 are indistinguishable.
constexpr double kLeastGravity_mps2 = 3;

}  // namespace

bool ImuWatch::saturated(const Reading& reading) {
  bool any = false;
  for (int axis = 0; axis < 6; ++axis) {
    const double size = std::abs(reading[axis]);
    const double least = axis < 3 ? kLeastRange_radps : kLeastRange_g * options_.gravity_mps2;
    if (size > largest_[axis]) {
      largest_[axis] = size;
      at_largest_[axis] = 0;
    }
    at_largest_[axis] = size == largest_[axis] && size > least ? at_largest_[axis] + 1 : 0;
    any |= at_largest_[axis] >= kSaturated;
  }
  return any;
}

ImuWatch::Finding ImuWatch::look(const Eigen::Vector3d& gyro_radps,
                                 const Eigen::Vector3d& accel_mps2, Diagnostics& diagnostics) {
  Finding finding;
  Reading reading;
  reading << gyro_radps, accel_mps2;
  if (options_.noisy) {
    repeated_ = reading == last_ ? std::min(repeated_ + 1, kFrozen) : 0;
    last_ = reading;
    const bool is_frozen = repeated_ >= kFrozen;
    const bool is_saturated = saturated(reading) && !is_frozen;
    if (is_frozen) diagnostics.add(Fault::imu_frozen);
    if (is_saturated) diagnostics.add(Fault::imu_saturated);
    finding.believed = !is_frozen && !is_saturated;
  }
  const double size = accel_mps2.norm();
  const bool like_g =
      options_.gravity_mps2 > kLeastGravity_mps2 && size > kLeast_g && size < kMost_g;
  const int before = in_g_;
  in_g_ = like_g ? std::min(in_g_ + 1, kInG) : 0;
  if (in_g_ == kInG) {
    finding.accel_scale = options_.gravity_mps2;
    finding.begins_in_g = before < kInG;
    diagnostics.add(Fault::imu_in_g, finding.begins_in_g ? kInG : 1);
  }
  return finding;
}

}  // namespace lcs
