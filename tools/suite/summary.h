/// \file
/// Means of a suite's figures over the seeds of a scenario and over the scenarios of a group.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// Finds a scenario or run; null if there is none.
const ScenarioResult* find(const SuiteResult& suite, const std::string& name);
const RunResult* find(const ScenarioResult& scenario, std::uint64_t seed);

/// A metric of a run, or `scoring::kSizeShare`. Absent if undefined, unknown or without figures.
std::optional<double> figure_of(const RunResult& run, std::string_view name);

struct Spread {
  double mean = 0;
  double half = 0;  ///< half the range, (max - min) / 2
  int count = 0;    ///< number of seeds with the figure, >= 1
};

/// The spread of a figure over the seeds; absent if no seed has it.
std::optional<Spread> over_seeds(const ScenarioResult& scenario, std::string_view name);

/// The mean over the seeds; absent if no seed has the figure or the scenario is unknown.
std::optional<double> mean_over_seeds(const SuiteResult& suite, const std::string& scenario,
                                      std::string_view name);

/// The mean over seeds of each scenario of a group that has the figure.
std::vector<double> figures_of_group(const SuiteResult& suite, const std::string& group,
                                     std::string_view name);

/// The mean of `figures_of_group`; absent if that is empty.
std::optional<double> over_group(const SuiteResult& suite, const std::string& group,
                                 std::string_view name);

bool is_in(const ScenarioResult& scenario, const std::string& group);
/// The group with the numbers of scenarios that its means are over, such as "short (43, 39 with
/// F1)": those with F1 also have precision and recall.
std::string counted_group(const SuiteResult& suite, const std::string& group);

/// The group of all scenarios, in suites where no other group has them all.
inline constexpr const char* kAll = "all";

/// The groups in the order of their first appearance, after `kAll`. Scenarios without any figures
/// do not count.
std::vector<std::string> groups_of(const SuiteResult& suite);

/// Whether all scenarios are worlds drawn from seeds: a random sample, whose mean has an interval.
/// False without scenarios.
bool is_of_worlds(const SuiteResult& suite);

/// The number of redraws over all worlds.
std::int64_t drawn_again(const SuiteResult& suite);

/// Judges the criteria over seeds by the figures of all runs, and the runs' outcomes by all
/// criteria. Each run of the scenario has the same verdict of such a criterion.
void judge_over_seeds(ScenarioResult& scenario);

/// The worst outcome of the runs; `error` without runs.
Outcome outcome_of(const ScenarioResult& scenario);
Outcome outcome_of(const SuiteResult& suite);

}  // namespace lcs::suite
