#include "tools/suite/parts.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <numeric>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "tools/files/csv.h"
#include "tools/suite/summary.h"

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

SuiteResult merge(std::span<const SuiteInFolder> parts) {
  for (const SuiteInFolder& part : parts) {
    if (!part.suite.part_of) {
      throw std::runtime_error(
          fmt::format("{} is a whole suite, no part of one; lcs suite --shard I/N makes parts",
                      part.folder.string()));
    }
    const PartOf &first = *parts.front().suite.part_of, &other = *part.suite.part_of;
    if (first.whole == other.whole && first.shard.parts == other.shard.parts) continue;
    throw std::runtime_error(fmt::format(
        "{} and {} are no parts of one suite: the scenarios, seeds or numbers of parts differ",
        parts.front().folder.string(), part.folder.string()));
  }
  const SuiteResult& first = parts.front().suite;
  SuiteResult whole = first;
  whole.part_of.reset();
  whole.scenarios.clear();
  std::size_t missing = 0;
  for (const auto& [name, seeds] : first.part_of->whole) {
    ScenarioResult joined;
    for (const std::uint64_t seed : seeds) {
      const SuiteInFolder* owner = nullptr;
      for (const SuiteInFolder& part : parts) {
        const ScenarioResult* scenario = find(part.suite, name);
        const RunResult* run = scenario ? find(*scenario, seed) : nullptr;
        if (!run) continue;
        if (owner) {
          throw std::runtime_error(
              fmt::format("{} and {} both have {} seed {}; the parts of one suite have the same "
                          "--times, or none",
                          owner->folder.string(), part.folder.string(), name, seed));
        }
        owner = &part;
        if (joined.name.empty()) {
          joined = *scenario;
          joined.runs.clear();
        }
        joined.runs.push_back(*run);
      }
      missing += owner == nullptr;
    }
    judge_over_seeds(joined);
    whole.scenarios.push_back(std::move(joined));
  }
  if (missing > 0) {
    std::set<int> there, lacking;
    for (const SuiteInFolder& part : parts) there.insert(part.suite.part_of->shard.part);
    for (int i = 1; i <= first.part_of->shard.parts; ++i) {
      if (!there.contains(i)) lacking.insert(i);
    }
    throw std::runtime_error(fmt::format(
        "the parts lack {} of the runs of the whole suite: {}", missing,
        lacking.empty() ? "the parts were made with different --times"
                        : fmt::format("there is no part {} of {}", fmt::join(lacking, ", "),
                                      first.part_of->shard.parts)));
  }
  return whole;
}

}  // namespace lcs::suite
