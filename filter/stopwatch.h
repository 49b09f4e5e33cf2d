/// \file
/// Wall times of consecutive stages.
#pragma once

#include <chrono>
#include <utility>

namespace lcs {

class Stopwatch {
 public:
  /// ms since the last call, or since construction.
  double lap_ms() {
    const auto from = std::exchange(start_, Clock::now());
    return std::chrono::duration<double, std::milli>(start_ - from).count();
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace lcs
