/// \file
/// A comparison that ends as soon as its verdict is certain: a group-sequential test. The runs of a
/// suite are made in an order that depends on no result, and after equal parts of them the suite
/// is compared with its baseline. `tools/suite/README.md` states the measured error rates.
///
/// At look k of K the verdicts spend .05 (k^2 - (k - 1)^2) / K^2 of the probability of a false
/// alarm (Kim and DeMets, Biometrika 74, 1987). Each look is a test by itself, so that by
/// Bonferroni's inequality all looks together have at most .05, whatever the figures' correlation.
#pragma once

#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "tools/suite/comparison.h"
#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// A scenario or world, and its seeds.
struct Planned {
  std::string name;
  std::string family;  ///< of a world; "" of other scenarios
  std::vector<std::uint64_t> seeds;
};

/// A scenario's name and a seed.
using RunName = std::pair<std::string, std::uint64_t>;

/// All runs by their seeds' places: first the first seed of each scenario. Families take turns, the
/// one with the lowest F1 in the baseline first. Within a family worlds keep their order, which is
/// drawn by chance, and other scenarios are mixed by a digest of their names.
std::vector<RunName> order_of(std::span<const Planned> plan, const SuiteResult& baseline);

/// The looks of a suite of so many runs: how many runs each has, and its probability of a false
/// alarm. The last has all runs. At most six, of at least five runs each.
std::vector<Look> looks_of(std::size_t runs);

/// The suite with these runs alone. Criteria over seeds are as in the whole suite.
SuiteResult with_runs(const SuiteResult& suite, const std::set<RunName>& runs);

/// Whether no further run can be expected to change the verdict: a main mean has regressed; or,
/// with half of the runs or more, all are equal or none can be expected to regress. The last is so
/// if no regression would be found at the end even if the runs that follow were worse by one
/// standard error than those so far.
/// \param comparison of the runs up to a look. \param looks of `looks_of`. \param look its index.
bool is_certain(const Comparison& comparison, std::span<const Look> looks, std::size_t look);

}  // namespace lcs::suite
