#include "tools/process/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lcs::process {

void for_each_parallel(int count, const std::function<void(int)>& work,
                       const std::function<void(int)>& tick) {
  std::atomic<int> next = 0, done = 0;
  std::atomic<bool> is_over = false;
  std::mutex mutex;
  std::exception_ptr problem;  // the first one
  int told = 0;
  const auto run = [&](bool tells) {
    try {
      for (int i = next++; i < count && !is_over; i = next++) {
        work(i);
        ++done;
        if (!tells) continue;
        const int now = done;
        tick(now - told);
        told = now;
      }
    } catch (...) {
      const std::lock_guard lock(mutex);
      if (!problem) problem = std::current_exception();
      is_over = true;
    }
  };
  {
    const int cores = static_cast<int>(std::max(1u, std::thread::hardware_concurrency()));
    std::vector<std::jthread> helpers;
    for (int i = 1; i < std::min(cores, count); ++i) helpers.emplace_back(run, false);
    run(true);
  }
  if (problem) std::rethrow_exception(problem);
  if (told < count) tick(count - told);
}

}  // namespace lcs::process
