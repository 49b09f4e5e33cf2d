#include "tools/suite/summary.h"

#include <fmt/format.h>

#include <algorithm>

#include "tools/scoring/metrics.h"
#include "tools/scoring/statistics.h"
#include "tools/suite/interval.h"

namespace lcs::suite {
namespace {

std::optional<double> metric_of(const RunResult& run, std::string_view name) {
  const auto found = std::ranges::find(run.metrics, name, &scoring::Metrics::value_type::first);
  return found == run.metrics.end() ? std::nullopt : found->second;
}

/// \param values of the seeds; one of them undefined meets no bound.
void judge_over_seeds(scoring::JudgedCriterion& criterion,
                      const std::vector<std::optional<double>>& values) {
  std::vector<double> defined;
  for (const std::optional<double>& value : values) {
    if (value) defined.push_back(*value);
  }
  criterion.value.reset();
  criterion.met = false;
  std::string found = "undefined";
  if (defined.size() == values.size()) {
    const Interval mean = interval_of(defined);
    const bool is_interval = criterion.over == "interval";
    const double half = is_interval ? mean.half.value_or(0) : 0;
    criterion.value = mean.mean;
    criterion.met = (!is_interval || mean.half) &&
                    (!criterion.min || mean.mean - half >= *criterion.min) &&
                    (!criterion.max || mean.mean + half <= *criterion.max);
    found = fmt::format("{:.4g}", mean.mean);
    if (is_interval) {
      found = mean.half ? fmt::format("from {:.4g} to {:.4g}", mean.mean - half, mean.mean + half)
                        : found + " with unknown noise";
    }
  }
  criterion.message =
      criterion.met ? ""
                    : fmt::format("{}: {} is {}, the {} over {} seed{}, must be {}",
                                  criterion.place, criterion.metric, found,
                                  criterion.over == "mean" ? "mean" : "95 % interval of the mean",
                                  values.size(), values.size() == 1 ? "" : "s",
                                  scoring::bounds(criterion.min, criterion.max));
}

}  // namespace

const ScenarioResult* find(const SuiteResult& suite, const std::string& name) {
  const auto found = std::ranges::find(suite.scenarios, name, &ScenarioResult::name);
  return found == suite.scenarios.end() ? nullptr : &*found;
}

const RunResult* find(const ScenarioResult& scenario, std::uint64_t seed) {
  const auto found = std::ranges::find(scenario.runs, seed, &RunResult::seed);
  return found == scenario.runs.end() ? nullptr : &*found;
}

std::optional<double> figure_of(const RunResult& run, std::string_view name) {
  if (name != scoring::kSizeShare) return metric_of(run, name);
  const std::optional<double> size = metric_of(run, "dimension.mean");
  const std::optional<double> store = metric_of(run, "dimension.five_frame_mean");
  return size && store ? scoring::ratio(*size, *store) : std::nullopt;
}

std::optional<Spread> over_seeds(const ScenarioResult& scenario, std::string_view name) {
  std::vector<double> figures;
  for (const RunResult& run : scenario.runs) {
    if (const auto figure = figure_of(run, name)) figures.push_back(*figure);
  }
  if (figures.empty()) return std::nullopt;
  const auto [least, greatest] = std::minmax_element(figures.begin(), figures.end());
  return Spread{*scoring::mean(figures), (*greatest - *least) / 2,
                static_cast<int>(figures.size())};
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
  return scoring::mean(figures_of_group(suite, group, name));
}

bool is_in(const ScenarioResult& scenario, const std::string& group) {
  return group == kAll || std::ranges::find(scenario.groups, group) != scenario.groups.end();
}

std::string counted_group(const SuiteResult& suite, const std::string& group) {
  const auto all = std::ranges::count_if(
      suite.scenarios, [&](const ScenarioResult& scenario) { return is_in(scenario, group); });
  const auto with_f1 = std::ssize(figures_of_group(suite, group, scoring::kF1));
  return with_f1 == all ? fmt::format("{} ({})", group, all)
                        : fmt::format("{} ({}, {} with F1)", group, all, with_f1);
}

std::vector<std::string> groups_of(const SuiteResult& suite) {
  std::vector<std::string> groups;
  for (const ScenarioResult& scenario : suite.scenarios) {
    for (const std::string& group : scenario.groups) {
      if (std::ranges::find(groups, group) == groups.end()) groups.push_back(group);
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
  return !suite.scenarios.empty() && std::ranges::all_of(suite.scenarios, [](const auto& one) {
    return one.drawn.has_value();
  });
}

std::int64_t drawn_again(const SuiteResult& suite) {
  return std::ranges::count_if(suite.scenarios, [](const ScenarioResult& scenario) {
    return scenario.drawn && scenario.drawn->again > 0;
  });
}

void judge_over_seeds(ScenarioResult& scenario) {
  std::size_t most = 0;
  for (const RunResult& run : scenario.runs) most = std::max(most, run.criteria.size());
  for (std::size_t i = 0; i < most; ++i) {
    std::vector<std::optional<double>> values;
    const scoring::JudgedCriterion* first = nullptr;
    for (const RunResult& run : scenario.runs) {
      if (i >= run.criteria.size()) continue;  // it ended with an error
      first = first ? first : &run.criteria[i];
      values.push_back(figure_of(run, run.criteria[i].metric));
    }
    if (first->over == "seed") continue;
    scoring::JudgedCriterion judged = *first;
    judge_over_seeds(judged, values);
    for (RunResult& run : scenario.runs) {
      if (i < run.criteria.size()) run.criteria[i] = judged;
    }
  }
  for (RunResult& run : scenario.runs) {
    if (run.outcome == Outcome::error) continue;
    const bool failed = std::ranges::any_of(
        run.criteria, [](const auto& criterion) { return criterion.required && !criterion.met; });
    run.outcome = failed ? Outcome::failed : Outcome::passed;
  }
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
