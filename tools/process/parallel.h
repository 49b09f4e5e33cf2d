/// \file
/// Runs independent tasks on all cores. Results depend on the task, not on the thread, so they are
/// the same for any number of cores.
#pragma once

#include <functional>

namespace lcs::process {

/// Calls `work(i)` for each i in [0, count) on several threads. After each task of the calling
/// thread, calls `tick` with the number of tasks done since the last call. An exception stops new
/// tasks; it is rethrown after the running ones.
void for_each_parallel(int count, const std::function<void(int)>& work,
                       const std::function<void(int)>& tick);

}  // namespace lcs::process
