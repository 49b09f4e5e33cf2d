/// \file
/// Sorts readings, poses and pictures by time, and removes duplicate times.
#pragma once

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <vector>

#include "tools/replay/recorded.h"

namespace lcs::replay {

/// Sorts items by `t_ns`, and removes all but the first of those with the same time; counts both in
/// `tally`. \param plural of the items, as "poses". \param source name of the table.
template <class Timed>
void sort_by_time(std::vector<Timed>& items, const std::string& plural, const std::string& source,
                  Tally& tally) {
  const auto earlier = [](const Timed& a, const Timed& b) { return a.t_ns < b.t_ns; };
  const auto same = [](const Timed& a, const Timed& b) { return a.t_ns == b.t_ns; };
  if (!std::is_sorted(items.begin(), items.end(), earlier)) {
    tally.add("tables are not in the order of time and are sorted", source);
    std::stable_sort(items.begin(), items.end(), earlier);
  }
  const auto twice = std::unique(items.begin(), items.end(), same);
  if (twice == items.end()) return;
  tally.add(plural + " have the time of another one and are left out",
            fmt::format("at {} ns", twice->t_ns), static_cast<int>(items.end() - twice));
  items.erase(twice, items.end());
}

}  // namespace lcs::replay
