#include "tools/suite/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

#include "tools/scoring/statistics.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

struct RunPair {
  const RunResult* before;
  const RunResult* after;
};

std::string seed_list(const std::vector<std::uint64_t>& seeds) {
  return fmt::format("{} {}", seeds.size() == 1 ? "seed" : "seeds", fmt::join(seeds, ", "));
}

/// The seeds of `one` that `other` lacks.
std::vector<std::uint64_t> seeds_without(const ScenarioResult& one, const ScenarioResult& other) {
  std::vector<std::uint64_t> seeds;
  for (const RunResult& run : one.runs) {
    if (!find(other, run.seed)) seeds.push_back(run.seed);
  }
  return seeds;
}

class Comparer {
 public:
  Comparer(const SuiteResult& before, const SuiteResult& after,
           const std::function<bool(std::string_view)>& is_wanted)
      : before_(before), after_(after), by_world_(is_of_worlds(after)) {
    for (const bench::Metric& metric : bench::metrics()) {
      if (!metric.is_time() && is_wanted(metric.key)) compared_.push_back(&metric);
    }
  }

  Comparison compare() {
    for (const ScenarioResult& scenario : before_.scenarios) {
      if (const ScenarioResult* other = find(after_, scenario.name)) {
        result_.scenarios.push_back(scenario.name);
        compare(scenario, *other);
      } else {
        note("{}: only before", scenario.name);
      }
    }
    for (const ScenarioResult& scenario : after_.scenarios) {
      if (!find(before_, scenario.name)) note("{}: only after", scenario.name);
    }
    for (const std::string& group : groups_of(after_)) {
      for (const bench::Metric* metric : compared_) compare_group(group, *metric);
    }
    return result_;
  }

 private:
  template <class... Arguments>
  void note(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    result_.incomparable.push_back(fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  void compare(const ScenarioResult& before, const ScenarioResult& after) {
    const std::vector<RunPair> pairs = pair_up(before, after);
    for (const bench::Metric* metric : compared_) compare(before.name, *metric, pairs);
  }

  /// Pairs of runs with the same seed, both with figures.
  std::vector<RunPair> pair_up(const ScenarioResult& before, const ScenarioResult& after) {
    if (const auto seeds = seeds_without(before, after); !seeds.empty()) {
      note("{}: {} only before", before.name, seed_list(seeds));
    }
    if (const auto seeds = seeds_without(after, before); !seeds.empty()) {
      note("{}: {} only after", before.name, seed_list(seeds));
    }
    std::vector<RunPair> pairs;
    for (const RunResult& run : before.runs) {
      const RunResult* other = find(after, run.seed);
      if (!other) continue;
      if (run.metrics.empty() || other->metrics.empty()) {
        const bool is_lost = !run.metrics.empty();
        if (is_lost) result_.lost.insert(before.name);
        const char* when = is_lost                  ? "after"
                           : other->metrics.empty() ? "before and after"
                                                    : "before";
        note("{}: seed {} ended with an error {}", before.name, run.seed, when);
        continue;
      }
      pairs.push_back({&run, other});
    }
    return pairs;
  }

  void compare(const std::string& scenario, const bench::Metric& metric,
               const std::vector<RunPair>& pairs) {
    std::vector<double> before, after, changes;
    std::vector<std::optional<double>> by_pair;
    std::vector<std::uint64_t> lost, gained;  // seeds with the figure only before, only after
    for (const RunPair& pair : pairs) {
      const std::optional<double> was = figure_of(*pair.before, metric.key);
      const std::optional<double> is = figure_of(*pair.after, metric.key);
      if (was && !is) lost.push_back(pair.before->seed);
      if (!was && is) gained.push_back(pair.before->seed);
      by_pair.push_back(was && is ? std::optional(*is - *was) : std::nullopt);
      if (!was || !is) continue;
      before.push_back(*was);
      after.push_back(*is);
      changes.push_back(*is - *was);
    }
    if (!lost.empty()) note("{}: {} undefined after, {}", scenario, metric.key, seed_list(lost));
    if (!gained.empty()) {
      note("{}: {} undefined before, {}", scenario, metric.key, seed_list(gained));
    }
    if (changes.empty()) return;

    result_.differences.push_back(
        difference_of(scenario, metric, *bench::mean(before), *bench::mean(after), changes));
    changes_[{scenario, metric.key}] = std::move(by_pair);
    result_.judged += metric.scale.better != bench::Direction::neutral;
    result_.single_seeds |= changes.size() == 1;
  }

  /// Worlds are a random sample, so each world's change is a sample. The project's own scenarios
  /// are a fixed set, so a sample is the mean change over the scenarios for one seed.
  void compare_group(const std::string& group, const bench::Metric& metric) {
    std::vector<double> before, after;
    std::vector<std::vector<double>> samples;
    for (const Difference& one : result_.differences) {
      const ScenarioResult* scenario = find(after_, one.scenario);
      if (one.metric != metric.key || !scenario || !is_in(*scenario, group)) continue;
      before.push_back(one.before);
      after.push_back(one.after);
      if (by_world_) {
        samples.push_back({one.change.mean});
        continue;
      }
      const auto& changes = changes_.at({one.scenario, one.metric});
      samples.resize(std::max(samples.size(), changes.size()));
      for (std::size_t i = 0; i < changes.size(); ++i) {
        if (changes[i]) samples[i].push_back(*changes[i]);
      }
    }
    if (before.empty()) return;
    std::vector<double> changes;
    for (const std::vector<double>& sample : samples) {
      if (const auto mean = bench::mean(sample)) changes.push_back(*mean);
    }
    result_.groups.push_back(
        difference_of(group, metric, *bench::mean(before), *bench::mean(after), changes));
  }

  /// A change is real if its whole interval lies beyond the least change that matters.
  static Difference difference_of(const std::string& name, const bench::Metric& metric,
                                  double before, double after, const std::vector<double>& changes) {
    Difference difference{.scenario = name,
                          .metric = metric.key,
                          .better = metric.scale.better,
                          .before = before,
                          .after = after,
                          .change = interval_of(changes),
                          .seeds = static_cast<int>(changes.size())};
    const double certain = std::abs(difference.change.mean) - difference.change.half.value_or(0);
    const double least = least_change(metric.scale, before);
    if (certain <= least) return difference;
    const int sign = sign_of_change(metric.scale.better, before, after);
    difference.verdict = sign > 0 ? Change::improved : sign < 0 ? Change::regressed : Change::moved;
    difference.weight = least > 0 ? certain / least : 1;
    return difference;
  }

  const SuiteResult& before_;
  const SuiteResult& after_;
  bool by_world_;
  std::vector<const bench::Metric*> compared_;
  std::map<std::pair<std::string, std::string>, std::vector<std::optional<double>>> changes_;
  Comparison result_;
};

// ---- In words

int decimals_of(double value) {
  return std::abs(value) < 10 ? 3 : std::abs(value) < 1000 ? 1 : 0;
}

std::string number(double value) {
  return fmt::format("{:.{}f}", value, decimals_of(value));
}

std::string signed_number(double value) {
  return fmt::format("{:+.{}f}", value, decimals_of(value));
}

std::string interval_text(const Interval& change) {
  if (!change.half) return "noise unknown";
  return fmt::format("[{}, {}]", signed_number(change.mean - *change.half),
                     signed_number(change.mean + *change.half));
}

std::string line_of(const Difference& difference, std::size_t scenario_width,
                    std::size_t metric_width) {
  return fmt::format("  {:<{}}  {:<{}}  {:>7} -> {:>7}  {:>7}  {}\n", difference.scenario,
                     scenario_width, difference.metric, metric_width, number(difference.before),
                     number(difference.after), signed_number(difference.change.mean),
                     interval_text(difference.change));
}

std::string section(const Comparison& comparison, Change verdict, const char* title) {
  if (comparison.count(verdict) == 0) return "";
  std::size_t scenario_width = 0, metric_width = 0;
  for (const Difference& difference : comparison.differences) {
    if (difference.verdict != verdict) continue;
    scenario_width = std::max(scenario_width, difference.scenario.size());
    metric_width = std::max(metric_width, difference.metric.size());
  }
  std::string text = fmt::format("{}:\n", title);
  for (const Difference& difference : comparison.differences) {
    if (difference.verdict != verdict) continue;
    text += line_of(difference, scenario_width, metric_width);
  }
  return text;
}

}  // namespace

int Comparison::count(Change verdict) const {
  return static_cast<int>(
      std::count_if(differences.begin(), differences.end(),
                    [&](const Difference& difference) { return difference.verdict == verdict; }));
}

std::string Comparison::note() const {
  return single_seeds ? "some figures are of a single seed that both have, whose noise is unknown: "
                        "their differences are plain ones"
                      : "";
}

std::optional<Change> Comparison::of_scenario(const std::string& name) const {
  if (lost.contains(name)) return Change::regressed;
  std::optional<Change> worst;
  for (const Difference& difference : differences) {
    if (difference.scenario != name) continue;
    if (difference.verdict == Change::regressed) return Change::regressed;
    if (difference.verdict == Change::improved) worst = Change::improved;
    if (!worst) worst = Change::none;
  }
  return worst;
}

bool Comparison::has_regressed() const {
  return !lost.empty() || count(Change::regressed) > 0;
}

Comparison compare(const SuiteResult& before, const SuiteResult& after,
                   const std::function<bool(std::string_view metric)>& is_wanted) {
  return Comparer(before, after, is_wanted).compare();
}

std::string text_of(const Comparison& comparison, bool all) {
  std::string text = section(comparison, Change::regressed, "regressed");
  text += section(comparison, Change::improved, "improved");
  if (all) {
    text += section(comparison, Change::moved, "moved (neither way is better)");
    text += section(comparison, Change::none, "no real change");
  }
  if (!comparison.incomparable.empty()) {
    text += "not compared:\n";
    for (const std::string& what : comparison.incomparable) text += fmt::format("  {}\n", what);
  }
  if (comparison.single_seeds) text += comparison.note() + '\n';
  const int improved = comparison.count(Change::improved);
  const int regressed = comparison.count(Change::regressed);
  text +=
      fmt::format("{} figures judged: {} regressed, {} improved, {} as before\n", comparison.judged,
                  regressed, improved, comparison.judged - improved - regressed);
  return text;
}

std::string change_text(const Difference& difference) {
  std::string text = fmt::format("{} -> {}", number(difference.before), number(difference.after));
  if (difference.change.half) text += fmt::format(" {}", interval_text(difference.change));
  return text;
}

}  // namespace lcs::suite
