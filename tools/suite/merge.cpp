#include "tools/suite/merge.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <utility>

#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

/// \throws std::runtime_error
void require_same(const SuiteInFolder& first, const SuiteInFolder& other) {
  const SuiteResult &a = first.suite, &b = other.suite;
  const auto require = [&](bool is_same, const std::string& what, const std::string& one,
                           const std::string& two) {
    if (is_same) return;
    throw std::runtime_error(
        fmt::format("{} and {} are no parts of one suite: {} differ{}", first.folder.string(),
                    other.folder.string(), what,
                    one.empty() && two.empty() ? "" : fmt::format(", '{}' and '{}'", one, two)));
  };
  const auto texts = [](const std::vector<std::string>& all) {
    return fmt::format("{}", fmt::join(all, ", "));
  };
  require(a.detector == b.detector, "the detectors", a.detector, b.detector);
  require(a.sets == b.sets, "the settings", texts(a.sets), texts(b.sets));
  require(a.version == b.version, "the versions", a.version, b.version);
  require(a.recorded == b.recorded, "the recordings", a.recorded, b.recorded);
  require(a.beside == b.beside, "the detectors beside", texts(a.beside), texts(b.beside));
  require(a.split == b.split, "the splits", a.split, b.split);
  require(a.part_of->shard.parts == b.part_of->shard.parts, "the numbers of parts",
          std::to_string(a.part_of->shard.parts), std::to_string(b.part_of->shard.parts));
  require(a.part_of->whole == b.part_of->whole, "the scenarios and seeds of the whole", "", "");
}

}  // namespace

SuiteResult merge(std::span<const SuiteInFolder> parts) {
  std::map<std::string, std::pair<std::string, const SuiteInFolder*>> digests;
  for (const SuiteInFolder& part : parts) {
    if (!part.suite.part_of) {
      throw std::runtime_error(
          fmt::format("{} is a whole suite, no part of one; lcs suite --shard I/N makes parts",
                      part.folder.string()));
    }
    require_same(parts.front(), part);
    for (const auto& [name, digest] : part.suite.part_of->scenario_sha256) {
      const auto known = digests.emplace(name, std::pair(digest, &part)).first->second;
      if (known.first == digest) continue;
      throw std::runtime_error(
          fmt::format("{} and {} are no parts of one suite: the files of the scenario {} differ",
                      known.second->folder.string(), part.folder.string(), name));
    }
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
