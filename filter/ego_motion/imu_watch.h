/// \file
/// Detects IMU faults from the readings alone: frozen, saturated, or accelerometer in g.
#pragma once

#include <Eigen/Core>
#include <array>

#include "filter/types/diagnostics.h"

namespace lcs {

class ImuWatch {
 public:
  struct Options {
    double gravity_mps2 = 9.81;
    bool noisy = true;  ///< false: ideal IMU, not checked for frozen or saturated readings
  };
  explicit ImuWatch(const Options& options) : options_(options) {}

  struct Finding {
    bool believed = true;      ///< neither frozen nor saturated
    double accel_scale = 1;    ///< factor to m/s^2
    bool begins_in_g = false;  ///< g detected now; the last `kInG` were not scaled
  };
  /// Checks a finite reading; call in order of time.
  Finding look(const Eigen::Vector3d& gyro_radps, const Eigen::Vector3d& accel_mps2,
               Diagnostics& diagnostics);

  /// Number of successive readings after which the unit g is accepted.
  static constexpr int kInG = 20;
  /// At rest a reading in g has magnitude 1. In m/s^2 that is nearly free fall, which does not last
  /// for `kInG` readings.
  static constexpr double kLeast_g = 0.7, kMost_g = 1.4;
  /// Current number of successive readings that look like g, up to `kInG`.
  int in_g() const { return in_g_; }

 private:
  using Reading = Eigen::Matrix<double, 6, 1>;
  bool saturated(const Reading& reading);

  Options options_;
  Reading last_ = Reading::Zero();
  int repeated_ = 0;
  Reading largest_ = Reading::Zero();  ///< largest magnitude of each axis so far
  std::array<int, 6> at_largest_{};    ///< successive readings at that magnitude
  int in_g_ = 0;
};

}  // namespace lcs
