/// \file
/// Independent pieces of work on all cores. Results belong to the piece, not to the thread, so that
/// they are the same with any number of cores.
#pragma once

#include <functional>

namespace lcs::process {

/// Calls `work(i)` for each i in [0, count), from several threads, and `tick` after each piece of
/// the calling thread with the number of pieces since the last call. What either throws ends all,
/// once the pieces under way are done, and is thrown on.
void for_each_parallel(int count, const std::function<void(int)>& work,
                       const std::function<void(int)>& tick);

}  // namespace lcs::process
