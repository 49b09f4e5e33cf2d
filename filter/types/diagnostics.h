/// \file
/// Counts of faults in the input. Bad data never throw: the filter drops or bridges a bad sample
/// and counts it here.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <numeric>
#include <string>
#include <vector>

namespace lcs {

enum class Fault : std::uint8_t {
  // Corners.
  corner_not_finite,
  corner_outside,
  corner_repeated,
  corner_too_many,
  // Given ego-motion.
  time_still,
  time_back,
  time_jump,
  motion_not_finite,
  motion_too_fast,
  motion_no_rotation,
  motion_contradicted,
  ground_unusable,
  // IMU and odometry of the ego-motion estimator.
  imu_not_finite,
  imu_too_large,
  imu_out_of_order,
  imu_jump,
  imu_gap,
  imu_saturated,
  imu_frozen,
  imu_in_g,
  odometry_unusable,
  odometry_out_of_order,
  clock_set,
};

struct FaultText {
  const char* word;
  const char* meaning;  ///< human-readable, printed after the count
};

/// In the order of `Fault`.
inline constexpr std::array<FaultText, 23> kFaults{{
    {"corner_not_finite", "corners are at no number: left out"},
    {"corner_outside", "corners are outside of the picture: left out"},
    {"corner_repeated", "corners are at the place of another one: they get its verdict"},
    {"corner_too_many", "corners are more than line.max_corners: the outermost are left out"},
    {"time_still", "frames come at the time of the one before: no rebel can be told"},
    {"time_back", "frames are older than the one before: the filter started anew"},
    {"time_jump", "frames are over 60 s after the one before: the filter started anew"},
    {"motion_not_finite", "ego-motions are no numbers: the filter started anew"},
    {"motion_too_fast", "ego-motions are over 1000 m/s or rad/s: the filter started anew"},
    {"motion_no_rotation",
     "ego-motions have a matrix that is no rotation: the filter started anew"},
    {"motion_contradicted",
     "ego-motions contradict the picture: the one before was kept, or the filter started anew"},
    {"ground_unusable", "ego-motions have a ground that is none: it is not used"},
    {"imu_not_finite", "readings of the IMU are no numbers: left out"},
    {"imu_too_large", "readings of the IMU are over 100 rad/s or 2000 m/s^2: left out"},
    {"imu_out_of_order", "readings of the IMU are older than what is known: left out"},
    {"imu_jump", "readings of the IMU are over 60 s ahead of what is known: left out"},
    {"imu_gap", "gaps are in the readings of the IMU, in which the last one is held"},
    {"imu_saturated",
     "readings of the IMU stay at the end of its range: odometry is believed more"},
    {"imu_frozen", "readings of the IMU repeat the one before to the bit: taken for silence"},
    {"imu_in_g", "readings of the accelerometer are in g, not m/s^2: taken times gravity"},
    {"odometry_unusable",
     "readings of the odometry are no numbers, over 1000 m/s or over 100 rad/s: left out"},
    {"odometry_out_of_order", "readings of the odometry are before what is known: left out"},
    {"clock_set", "times the clock was set anew: two frames in a row agreed on it"},
}};
static_assert(kFaults.size() == static_cast<std::size_t>(Fault::clock_set) + 1);

constexpr const FaultText& text_of(Fault fault) {
  return kFaults[static_cast<std::size_t>(fault)];
}

/// Number of occurrences of each fault.
class Diagnostics {
 public:
  void add(Fault fault, std::int64_t count = 1) {
    counts_[static_cast<std::size_t>(fault)] += count;
  }

  /// Resets the count of a fault that is reported elsewhere.
  void forget(Fault fault) { counts_[static_cast<std::size_t>(fault)] = 0; }

  std::int64_t count(Fault fault) const { return counts_[static_cast<std::size_t>(fault)]; }
  std::int64_t total() const {
    return std::accumulate(counts_.begin(), counts_.end(), std::int64_t{0});
  }

  Diagnostics& operator+=(const Diagnostics& other) {
    for (std::size_t i = 0; i < counts_.size(); ++i) counts_[i] += other.counts_[i];
    return *this;
  }

  /// One line for each fault that occurred: "3 corners are at no number: left out (corner_...)".
  std::vector<std::string> lines() const {
    std::vector<std::string> lines;
    for (std::size_t i = 0; i < counts_.size(); ++i) {
      if (counts_[i] == 0) continue;
      lines.push_back(std::to_string(counts_[i]) + ' ' + kFaults[i].meaning + " (" +
                      kFaults[i].word + ")");
    }
    return lines;
  }

 private:
  std::array<std::int64_t, kFaults.size()> counts_{};
};

}  // namespace lcs
