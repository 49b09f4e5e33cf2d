#include "tools/suite/summary.h"

#include <algorithm>

#include "tools/scoring/metrics.h"
#include "tools/scoring/statistics.h"

namespace lcs::suite {
namespace {

std::optional<double> metric_of(const RunResult& run, std::string_view name) {
  const auto found = std::find_if(run.metrics.begin(), run.metrics.end(),
                                  [&](const auto& metric) { return metric.first == name; });
  return found == run.metrics.end() ? std::nullopt : found->second;
}

}  // namespace

const ScenarioResult* find(const SuiteResult& suite, const std::string& name) {
  const auto found = std::find_if(suite.scenarios.begin(), suite.scenarios.end(),
                                  [&](const auto& scenario) { return scenario.name == name; });
  return found == suite.scenarios.end() ? nullptr : &*found;
}

const RunResult* find(const ScenarioResult& scenario, std::uint64_t seed) {
  const auto found = std::find_if(scenario.runs.begin(), scenario.runs.end(),
                                  [&](const auto& run) { return run.seed == seed; });
  return found == scenario.runs.end() ? nullptr : &*found;
}

const std::vector<std::string_view>& tabled_metrics() {
  static const std::vector<std::string_view> all{"rebel.precision",
                                                 "rebel.recall",
                                                 "rebel.f1",
                                                 "rebel.f1_distinct",
                                                 "rebel.latency_frames_median",
                                                 "rebel.object_recall",
                                                 "rebel.false_objects_per_100_frames",
                                                 "square.recall_50",
                                                 "square.precision_50",
                                                 bench::kSizeShare,
                                                 "time.filter_over_fast"};
  return all;
}

std::optional<double> figure_of(const RunResult& run, std::string_view name) {
  if (name != bench::kSizeShare) return metric_of(run, name);
  const std::optional<double> size = metric_of(run, "dimension.mean");
  const std::optional<double> store = metric_of(run, "dimension.five_frame_mean");
  return size && store ? bench::ratio(*size, *store) : std::nullopt;
}

std::optional<Spread> over_seeds(const ScenarioResult& scenario, std::string_view name) {
  std::vector<double> figures;
  for (const RunResult& run : scenario.runs) {
    if (const auto figure = figure_of(run, name)) figures.push_back(*figure);
  }
  if (figures.empty()) return std::nullopt;
  const auto [least, greatest] = std::minmax_element(figures.begin(), figures.end());
  return Spread{*bench::mean(figures), (*greatest - *least) / 2, static_cast<int>(figures.size())};
}

std::optional<double> mean_over_seeds(const SuiteResult& suite, const std::string& scenario,
                                      std::string_view name) {
  const ScenarioResult* found = find(suite, scenario);
  const auto spread = found ? over_seeds(*found, name) : std::nullopt;
  return spread ? std::optional(spread->mean) : std::nullopt;
}

std::vector<double> figures_of_group(const SuiteResult& suite, const std::string& group,
                                     std::string_view name) {
  std::vector<double> figures;
  for (const ScenarioResult& scenario : suite.scenarios) {
    if (!is_in(scenario, group)) continue;
    if (const auto spread = over_seeds(scenario, name)) figures.push_back(spread->mean);
  }
  return figures;
}

std::optional<double> over_group(const SuiteResult& suite, const std::string& group,
                                 std::string_view name) {
  return bench::mean(figures_of_group(suite, group, name));
}

bool is_in(const ScenarioResult& scenario, const std::string& group) {
  return group == kAll || std::ranges::find(scenario.groups, group) != scenario.groups.end();
}

std::int64_t count_in(const SuiteResult& suite, const std::string& group) {
  return std::count_if(suite.scenarios.begin(), suite.scenarios.end(),
                       [&](const ScenarioResult& scenario) { return is_in(scenario, group); });
}

std::vector<std::string> groups_of(const SuiteResult& suite) {
  std::vector<std::string> groups;
  for (const ScenarioResult& scenario : suite.scenarios) {
    for (const std::string& group : scenario.groups) {
      if (std::find(groups.begin(), groups.end(), group) == groups.end()) groups.push_back(group);
    }
  }
  const auto has_all = [&](const std::string& group) {
    return std::ranges::all_of(suite.scenarios, [&](const ScenarioResult& scenario) {
      return is_in(scenario, group) || std::ranges::all_of(scenario.runs, [](const auto& run) {
               return run.metrics.empty();
             });
    });
  };
  if (std::ranges::none_of(groups, has_all)) groups.insert(groups.begin(), kAll);
  return groups;
}

bool is_of_worlds(const SuiteResult& suite) {
  return !suite.scenarios.empty() &&
         std::all_of(suite.scenarios.begin(), suite.scenarios.end(),
                     [](const ScenarioResult& scenario) { return scenario.drawn.has_value(); });
}

std::int64_t drawn_again(const SuiteResult& suite) {
  return std::count_if(
      suite.scenarios.begin(), suite.scenarios.end(),
      [](const ScenarioResult& scenario) { return scenario.drawn && scenario.drawn->again > 0; });
}

Outcome outcome_of(const ScenarioResult& scenario) {
  Outcome worst = scenario.runs.empty() ? Outcome::error : Outcome::passed;
  for (const RunResult& run : scenario.runs) worst = std::max(worst, run.outcome);
  return worst;
}

Outcome outcome_of(const SuiteResult& suite) {
  Outcome worst = suite.scenarios.empty() ? Outcome::error : Outcome::passed;
  for (const ScenarioResult& scenario : suite.scenarios) {
    worst = std::max(worst, outcome_of(scenario));
  }
  return worst;
}

}  // namespace lcs::suite
