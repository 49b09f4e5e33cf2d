/// \file
/// A suite's figures in fewer numbers: over the seeds of a scenario, over the scenarios of a group.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

/// The scenario or run that is asked for; null where there is none.
const ScenarioResult* find(const SuiteResult& suite, const std::string& name);
const RunResult* find(const ScenarioResult& scenario, std::uint64_t seed);

/// A metric of a run, or `bench::kSizeShare`; none where undefined, unknown, or the run has no figures.
std::optional<double> figure_of(const RunResult& run, std::string_view name);

struct Spread {
  double mean = 0;
  double half = 0;  ///< of the distance between the least and the greatest
  int count = 0;    ///< seeds that have the figure, >= 1
};

/// The spread of a figure over the seeds; none where no seed has it.
std::optional<Spread> over_seeds(const ScenarioResult& scenario, std::string_view name);

/// The mean over the seeds; none where no seed has the figure, or no scenario the name.
std::optional<double> mean_over_seeds(const SuiteResult& suite, const std::string& scenario,
                                      std::string_view name);

/// The means over seeds of all scenarios of a group that have the figure.
std::vector<double> figures_of_group(const SuiteResult& suite, const std::string& group,
                                     std::string_view name);

/// The mean of `figures_of_group`; none where that is empty.
std::optional<double> over_group(const SuiteResult& suite, const std::string& group,
                                 std::string_view name);

bool is_in(const ScenarioResult& scenario, const std::string& group);
/// Scenarios of a group.
std::int64_t count_in(const SuiteResult& suite, const std::string& group);

/// In the order in which they first appear.
std::vector<std::string> groups_of(const SuiteResult& suite);

/// Whether its scenarios are worlds drawn from seeds, so that they are a sample of such worlds and
/// their mean has an interval. False for no scenarios.
bool is_of_worlds(const SuiteResult& suite);

/// Worlds that could not be drawn at first, and were drawn again.
std::int64_t drawn_again(const SuiteResult& suite);

/// The worst of the runs'; `error` for no runs.
Outcome outcome_of(const ScenarioResult& scenario);
Outcome outcome_of(const SuiteResult& suite);

}  // namespace lcs::suite
