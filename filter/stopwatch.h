/// \file
/// CPU times of consecutive stages of this thread. Unlike wall times they leave out the load of the
/// machine.
#pragma once

#include <chrono>
#include <ctime>
#include <utility>

namespace lcs {

/// The CPU time of the calling thread (POSIX).
struct ThreadClock {
  using duration = std::chrono::nanoseconds;
  using rep = duration::rep;
  using period = duration::period;
  using time_point = std::chrono::time_point<ThreadClock>;
  static constexpr bool is_steady = true;

  static time_point now() {
    timespec now{};
    ::clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return time_point(std::chrono::seconds(now.tv_sec) + std::chrono::nanoseconds(now.tv_nsec));
  }
};

template <class Clock = ThreadClock>
class Stopwatch {
 public:
  /// ms since the last call, or since construction.
  double lap_ms() {
    const auto from = std::exchange(start_, Clock::now());
    return std::chrono::duration<double, std::milli>(start_ - from).count();
  }

 private:
  typename Clock::time_point start_ = Clock::now();
};

}  // namespace lcs
