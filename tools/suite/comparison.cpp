#include "tools/suite/comparison.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tools/bench/statistics.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

bool is_time(std::string_view metric) {
  return metric.starts_with("time.") || metric.starts_with("sim.");
}

struct RunPair {
  const RunResult* before;
  const RunResult* after;
};

std::string seed_list(const std::vector<std::uint64_t>& seeds) {
  return fmt::format("{} {}", seeds.size() == 1 ? "seed" : "seeds", fmt::join(seeds, ", "));
}

/// Seeds of `one` for which `other` has no run.
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
      : before_(before), after_(after), is_wanted_(is_wanted) {}

  Comparison compare() {
    for (const ScenarioResult& scenario : before_.scenarios) {
      if (const ScenarioResult* other = find(after_, scenario.name)) {
        ++result_.scenarios;
        compare(scenario, *other);
      } else {
        note("{}: only before", scenario.name);
      }
    }
    for (const ScenarioResult& scenario : after_.scenarios) {
      if (!find(before_, scenario.name)) note("{}: only after", scenario.name);
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
    for (const MetricTraits& traits : metric_traits()) {
      if (!is_time(traits.name) && is_wanted_(traits.name)) compare(before.name, traits, pairs);
    }
  }

  /// The runs with figures that both have.
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
        result_.lost_runs |= is_lost;
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

  void compare(const std::string& scenario, const MetricTraits& traits,
               const std::vector<RunPair>& pairs) {
    std::vector<double> before, after, changes;
    std::vector<std::uint64_t> lost, gained;  // seeds in which the figure is defined on one side
    for (const RunPair& pair : pairs) {
      const std::optional<double> was = figure_of(*pair.before, traits.name);
      const std::optional<double> is = figure_of(*pair.after, traits.name);
      if (was && !is) lost.push_back(pair.before->seed);
      if (!was && is) gained.push_back(pair.before->seed);
      if (!was || !is) continue;
      before.push_back(*was);
      after.push_back(*is);
      changes.push_back(*is - *was);
    }
    if (!lost.empty()) note("{}: {} undefined after, {}", scenario, traits.name, seed_list(lost));
    if (!gained.empty()) {
      note("{}: {} undefined before, {}", scenario, traits.name, seed_list(gained));
    }
    if (changes.empty()) return;

    Difference& difference = result_.differences.emplace_back();
    difference.scenario = scenario;
    difference.metric = traits.name;
    difference.direction = traits.direction;
    difference.before = *bench::mean(before);
    difference.after = *bench::mean(after);
    difference.change = interval_of(changes);
    difference.seeds = static_cast<int>(changes.size());
    difference.verdict = verdict_of(difference, traits);
    result_.judged += traits.direction != Direction::neutral;
    result_.single_seeds |= !difference.change.half;
  }

  /// Real is what lies beyond the least change that matters with all of its interval.
  static Change verdict_of(const Difference& difference, const MetricTraits& traits) {
    const double certain = std::abs(difference.change.mean) - difference.change.half.value_or(0);
    if (certain <= least_change(traits, difference.before)) return Change::none;
    const int sign = sign_of_change(traits.direction, difference.before, difference.after);
    return sign > 0 ? Change::improved : sign < 0 ? Change::regressed : Change::moved;
  }

  const SuiteResult& before_;
  const SuiteResult& after_;
  const std::function<bool(std::string_view)>& is_wanted_;
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

std::string line_of(const Difference& difference, std::size_t scenario_width,
                    std::size_t metric_width) {
  const Interval& change = difference.change;
  return fmt::format("  {:<{}}  {:<{}}  {:>7} -> {:>7}  {:>7}  {}\n", difference.scenario,
                     scenario_width, difference.metric, metric_width, number(difference.before),
                     number(difference.after), signed_number(change.mean),
                     change.half
                         ? fmt::format("[{}, {}]", signed_number(change.mean - *change.half),
                                       signed_number(change.mean + *change.half))
                         : "noise unknown");
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
  if (comparison.single_seeds) {
    text +=
        "some scenarios have a single seed in common, whose noise is unknown: differences there "
        "are plain ones\n";
  }
  const int improved = comparison.count(Change::improved);
  const int regressed = comparison.count(Change::regressed);
  text +=
      fmt::format("{} scenarios, {} figures judged: {} improved, {} regressed, {} as they were\n",
                  comparison.scenarios, comparison.judged, improved, regressed,
                  comparison.judged - improved - regressed);
  return text;
}

}  // namespace lcs::suite
