/// \file
/// Synthetic suite results.
#pragma once

#include <string>
#include <vector>

#include "tools/suite/sequential.h"
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

/// The plan whose result a suite is.
inline std::vector<Planned> planned(const SuiteResult& suite) {
  std::vector<Planned> plan;
  for (const ScenarioResult& scenario : suite.scenarios) {
    Planned& one = plan.emplace_back();
    one.name = scenario.name;
    if (scenario.drawn) one.family = scenario.drawn->family;
    for (const RunResult& run : scenario.runs) one.seeds.push_back(run.seed);
  }
  return plan;
}

/// The suite as a look leaves it.
inline SuiteResult at_look(const SuiteResult& suite, const std::vector<RunName>& order,
                           const Look& look) {
  SuiteResult made =
      with_runs(suite, {order.begin(), order.begin() + static_cast<std::ptrdiff_t>(look.runs)});
  made.sequential = {look, order.size()};
  return made;
}

}  // namespace lcs::suite
