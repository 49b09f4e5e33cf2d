#include "tools/suite/shard.h"

#include <fmt/format.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <string_view>

#include "tools/files/csv.h"

namespace lcs::suite {

Shard shard_of(const std::string& text) {
  const std::size_t slash = text.find('/');
  const std::string_view all = text;
  const auto part = files::number_in<int>(all.substr(0, slash));
  const auto parts = files::number_in<int>(slash == text.npos ? "" : all.substr(slash + 1));
  if (!part || !parts || *part < 1 || *part > *parts) {
    throw std::invalid_argument(
        fmt::format("--shard is '{}'; it takes a part of all, from 1/N to N/N, as 3/16", text));
  }
  return {*part, *parts};
}

std::vector<int> parts_of(const std::vector<double>& seconds, int parts) {
  std::vector<std::size_t> order(seconds.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return seconds[a] > seconds[b]; });
  std::vector<double> load(static_cast<std::size_t>(parts), 0);
  std::vector<int> part(seconds.size());
  for (const std::size_t run : order) {
    const auto least = std::ranges::min_element(load);
    *least += seconds[run];
    part[run] = 1 + static_cast<int>(least - load.begin());
  }
  return part;
}

}  // namespace lcs::suite
