/// \file
/// Synthetic suite results.
#pragma once

#include <string>
#include <vector>

#include "tools/suite/suite_result.h"

namespace lcs::suite {

inline RunResult run_with(std::uint64_t seed, scoring::Metrics metrics) {
  RunResult run;
  run.seed = seed;
  run.outcome = Outcome::passed;
  run.metrics = std::move(metrics);
  return run;
}

/// One scenario with one metric, one value per seed, seeds from 1.
inline ScenarioResult scenario_with(const std::string& name, const std::string& metric,
                                    const std::vector<std::optional<double>>& values) {
  ScenarioResult scenario;
  scenario.name = name;
  scenario.groups = {"short"};
  for (std::size_t i = 0; i < values.size(); ++i) {
    scenario.runs.push_back(run_with(i + 1, {{metric, values[i]}}));
  }
  return scenario;
}

inline SuiteResult suite_with(std::vector<ScenarioResult> scenarios) {
  SuiteResult suite;
  suite.detector = std::string("lcs");
  suite.version = std::string("0");  // not the text itself: GCC 12 warns of its own assignment
  suite.scenarios = std::move(scenarios);
  return suite;
}

}  // namespace lcs::suite
