/// \file
/// Finds a faulty IMU by its readings alone: it repeats itself, is at the end of its range, or its
/// accelerometer counts in g.
#pragma once

#include <Eigen/Core>
#include <array>

#include "filter/diagnostics.h"

namespace lcs {

class ImuWatch {
 public:
  struct Options {
    double gravity_mps2 = 9.81;
    bool noisy = true;  ///< it has noise, so that a reading that repeats itself says nothing
  };
  explicit ImuWatch(const Options& options) : options_(options) {}

  struct Finding {
    bool believed = true;    ///< it measures: it is neither frozen nor saturated
    double accel_scale = 1;  ///< to m/s^2
    bool begins_in_g = false;  ///< this reading settles it; the `kInG` before it were not scaled
  };
  /// Of a finite reading, in order.
  Finding look(const Eigen::Vector3d& gyro_radps, const Eigen::Vector3d& accel_mps2,
               Diagnostics& diagnostics);

  /// Readings in a row of which the last shows that they are in g.
  static constexpr int kInG = 20;
  /// At rest a reading in g has size 1, which in m/s^2 is nearly free fall: not for `kInG`
  /// readings.
  static constexpr double kLeast_g = 0.7, kMost_g = 1.4;
  /// How many of them there are now, up to `kInG`.
  int in_g() const { return in_g_; }

 private:
  using Reading = Eigen::Matrix<double, 6, 1>;
  bool saturated(const Reading& reading);

  Options options_;
  Reading last_ = Reading::Zero();
  int repeated_ = 0;
  Reading largest_ = Reading::Zero();  ///< size of the largest value of each axis so far
  std::array<int, 6> at_largest_{};    ///< for how many readings in a row it is that
  int in_g_ = 0;
};

}  // namespace lcs
