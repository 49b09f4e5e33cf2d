/// \file
/// Measures the time of a call.
#pragma once

#include "filter/stopwatch.h"

namespace lcs::bench {

/// Runs `work` and stores its time in `ms`, also if it throws: the CPU time of this thread, or by
/// `std::chrono::steady_clock` the wall time.
template <class Clock = ThreadClock, class Work>
decltype(auto) timed(double& ms, Work&& work) {
  struct Timer {
    double& ms;
    Stopwatch<Clock> watch = {};
    ~Timer() { ms = watch.lap_ms(); }
  } timer{ms};
  return work();
}

}  // namespace lcs::bench
