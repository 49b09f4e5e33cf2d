/// \file
/// Measures the wall time of a call.
#pragma once

#include <chrono>

namespace lcs::bench {

/// Runs `work` and stores its wall time in `ms`, also if it throws.
template <class Work>
decltype(auto) timed(double& ms, Work&& work) {
  using Clock = std::chrono::steady_clock;
  struct Stopwatch {
    double& ms;
    Clock::time_point start = Clock::now();
    ~Stopwatch() { ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count(); }
  } stopwatch{ms};
  return work();
}

}  // namespace lcs::bench
