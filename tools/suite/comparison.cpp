#include "tools/suite/comparison.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

#include "tools/scoring/statistics.h"
#include "tools/suite/judgement.h"
#include "tools/suite/sequential.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

constexpr std::string_view kFrames = "frames";

/// A loss up to this many times the least change that matters counts as none.
constexpr double kMargin = 2;

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
      : before_(before), after_(after) {
    result_.is_of_worlds = is_of_worlds(after);
    if (after.sequential) result_.level = after.sequential->look.level;
    for (const scoring::Metric& metric : scoring::metrics()) {
      if (!metric.is_time() && is_wanted(metric.key)) compared_.push_back(&metric);
    }
    for (const std::string_view key : scoring::kMainFigures) {
      if (is_wanted(key)) main_.emplace(key);
    }
    if (!main_.empty()) return;
    for (const scoring::Metric* metric : compared_) {
      if (metric->scale.better != scoring::Direction::neutral) main_.insert(metric->key);
    }
  }

  Comparison compare() {
    for (const ScenarioResult& scenario : before_.scenarios) {
      if (const ScenarioResult* other = find(after_, scenario.name)) {
        result_.scenarios.push_back(scenario.name);
        compare(scenario, *other);
      } else {
        note("{}: only before", scenario.name);
        result_.missing.push_back(scenario.name);
      }
    }
    for (const ScenarioResult& scenario : after_.scenarios) {
      if (!find(before_, scenario.name)) note("{}: only after", scenario.name);
    }
    for (const std::string& group : groups_of(after_)) {
      for (const scoring::Metric* metric : compared_) compare_group(group, *metric);
    }
    judge_means();
    return result_;
  }

 private:
  template <class... Arguments>
  void note(fmt::format_string<Arguments...> format, Arguments&&... arguments) {
    result_.incomparable.push_back(fmt::format(format, std::forward<Arguments>(arguments)...));
  }

  void compare(const ScenarioResult& before, const ScenarioResult& after) {
    const std::vector<RunPair> pairs = pair_up(before, after);
    for (const scoring::Metric* metric : compared_) compare(before.name, *metric, pairs);
  }

  /// Pairs of runs with the same seed, both with figures.
  std::vector<RunPair> pair_up(const ScenarioResult& before, const ScenarioResult& after) {
    if (const auto seeds = seeds_without(before, after); !seeds.empty()) {
      note("{}: {} only before", before.name, seed_list(seeds));
      result_.missing.push_back(fmt::format("{} {}", before.name, seed_list(seeds)));
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
      const auto had = figure_of(run, kFrames), has = figure_of(*other, kFrames);
      if (had != has && had && has) {
        note("{}: seed {} has {} frames, before {}", before.name, run.seed, *has, *had);
        result_.missing.push_back(result_.incomparable.back());
      }
      pairs.push_back({&run, other});
    }
    return pairs;
  }

  void compare(const std::string& scenario, const scoring::Metric& metric,
               const std::vector<RunPair>& pairs) {
    std::vector<double> before, after, changes, f1_changes;
    std::vector<std::uint64_t> lost, gained;  // seeds with the figure only before, only after
    for (const RunPair& pair : pairs) {
      const std::optional<double> was = figure_of(*pair.before, metric.key);
      const std::optional<double> is = figure_of(*pair.after, metric.key);
      if (was && !is) lost.push_back(pair.before->seed);
      if (!was && is) gained.push_back(pair.before->seed);
      if (!was || !is) continue;
      before.push_back(*was);
      after.push_back(*is);
      changes.push_back(*is - *was);
      const std::optional<double> f1_was = figure_of(*pair.before, scoring::kF1);
      const std::optional<double> f1_is = figure_of(*pair.after, scoring::kF1);
      if (f1_was && f1_is) f1_changes.push_back(*f1_is - *f1_was);
    }
    if (!lost.empty()) {
      note("{}: {} undefined after, {}", scenario, metric.key, seed_list(lost));
      result_.undefined += main_.contains(metric.key);
    }
    if (!gained.empty()) {
      note("{}: {} undefined before, {}", scenario, metric.key, seed_list(gained));
    }
    if (changes.empty()) return;

    const Interval change = interval_of(changes, result_.level);
    result_.differences.push_back(
        difference_of(scenario, metric, *scoring::mean(before), *scoring::mean(after), change));
    result_.differences.back().pairs = static_cast<int>(changes.size());
    Difference& difference = result_.differences.back();
    if (chance_beyond(difference.change, least_of(difference)) <= result_.level) {
      difference.verdict = direction_of(difference, scoring::mean(f1_changes));
    } else if (!difference.change.half && difference.weight > 1) {
      difference.verdict = Change::unknown;
    }
    changes_[{scenario, metric.key}] = std::move(changes);
    if (!f1_changes.empty()) f1_changes_[scenario] = *scoring::mean(f1_changes);
    result_.judged += metric.scale.better != scoring::Direction::neutral;
  }

  /// Worlds are a random sample, so each world's change is a sample. The project's own scenarios
  /// are a fixed set: the noise of their mean comes from their seeds.
  void compare_group(const std::string& group, const scoring::Metric& metric) {
    std::vector<double> before, after, by_world;
    std::vector<std::vector<double>> strata;
    for (const Difference& one : result_.differences) {
      if (one.metric != metric.key) continue;
      if (!is_in(*find(after_, one.scenario), group)) continue;
      before.push_back(one.before);
      after.push_back(one.after);
      by_world.push_back(one.change.mean);
      strata.push_back(changes_.at({one.scenario, one.metric}));
    }
    if (before.empty()) return;
    result_.groups.push_back(
        difference_of(group, metric, *scoring::mean(before), *scoring::mean(after),
                      result_.is_of_worlds ? interval_of(by_world, result_.level)
                                           : interval_of_strata(strata, result_.level)));
    result_.groups.back().pairs = static_cast<int>(before.size());
  }

  void judge_means() {
    if (result_.groups.empty()) return;
    const std::string whole =
        std::ranges::max_element(result_.groups, {}, &Difference::pairs)->scenario;
    for (Difference& mean : result_.groups) {
      mean.is_main = mean.scenario == whole && main_.contains(mean.metric);
    }
    judge_means(true);
    judge_means(false);
  }

  /// The main means have one verdict in common, and so have the others, so that many figures do not
  /// make a false alarm likely.
  void judge_means(bool main) {
    std::vector<Difference*> judged;
    std::vector<double> chances;
    for (Difference& mean : result_.groups) {
      if (mean.is_main != main) continue;
      if (!mean.change.half) {
        if (mean.weight > 1) mean.verdict = Change::unknown;
        continue;
      }
      if (mean.better == scoring::Direction::neutral) continue;
      judged.push_back(&mean);
      chances.push_back(chance_beyond(mean.change, least_of(mean)));
    }
    const std::vector<bool> real = real_among(chances, result_.level);
    for (std::size_t i = 0; i < judged.size(); ++i) {
      if (real[i]) judged[i]->verdict = direction_of(*judged[i], f1_change(judged[i]->scenario));
    }
    result_.judged_means += static_cast<int>(judged.size());
  }

  static double least_of(const Difference& difference) {
    return least_change(scoring::metric(difference.metric).scale, difference.before);
  }

  std::optional<double> f1_change(const std::string& group) const {
    std::vector<double> changes;
    for (const auto& [scenario, change] : f1_changes_) {
      if (is_in(*find(after_, scenario), group)) changes.push_back(change);
    }
    return scoring::mean(changes);
  }

  /// A share of F1 that is lost also falls where F1 itself falls. That is not better.
  static Change direction_of(const Difference& difference, std::optional<double> f1_change) {
    const int sign = sign_of_change(difference.better, difference.before, difference.after);
    const bool is_lost_share = difference.metric.starts_with("rebel.f1_lost_");
    if (sign > 0 && is_lost_share && f1_change.value_or(0) < 0) return Change::moved;
    return sign > 0 ? Change::improved : sign < 0 ? Change::regressed : Change::moved;
  }

  /// Without a verdict.
  static Difference difference_of(const std::string& name, const scoring::Metric& metric,
                                  double before, double after, const Interval& change) {
    Difference difference{.scenario = name,
                          .metric = metric.key,
                          .better = metric.scale.better,
                          .before = before,
                          .after = after,
                          .change = change};
    const double certain = std::max(0.0, std::abs(change.mean) - change.half.value_or(0));
    const double least = least_of(difference);
    difference.weight = least > 0 ? certain / least : certain > 0 ? 2 : 0;
    return difference;
  }

  const SuiteResult& before_;
  const SuiteResult& after_;
  std::vector<const scoring::Metric*> compared_;
  std::set<std::string, std::less<>> main_;  // the keys of the main figures
  std::map<std::pair<std::string, std::string>, std::vector<double>> changes_;
  std::map<std::string, double> f1_changes_;  // means over the seeds, by scenario
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

/// A row each.
/// \param of_groups adds the number of scenarios to each name.
std::string table_of(const std::vector<const Difference*>& differences, bool of_groups,
                     scoring::Format format) {
  if (differences.empty()) return "";
  const std::string names = of_groups ? "mean over" : "scenario";
  scoring::FigureTable table{{{names, names},
                              {"figure", "figure"},
                              {"before", "before"},
                              {"after", "after"},
                              {"change", "change"},
                              {"verdict", "verdict"}}};
  for (const Difference* one : differences) {
    const auto figure = [](double value) -> scoring::Cell {
      return scoring::TableFigure{value, {}, decimals_of(value)};
    };
    const Interval& change = one->change;
    table.rows.push_back(
        {of_groups ? fmt::format("{} ({})", one->scenario, one->pairs) : one->scenario, one->metric,
         figure(one->before), figure(one->after),
         scoring::TableFigure{change.mean, change.half, decimals_of(change.mean), true},
         change.half ? word_of(one->verdict) : "noise unknown"});
  }
  return table_text(table, format);
}

}  // namespace

const char* word_of(Change change) {
  constexpr std::array<const char*, 5> kWords{"improved", "regressed", "moved", "none", "unknown"};
  return kWords.at(static_cast<std::size_t>(change));
}

const char* word_of(Finding finding) {
  constexpr std::array<const char*, 4> kWords{"regressed", "not judged", "no regression found",
                                              "equal"};
  return kWords.at(static_cast<std::size_t>(finding));
}

double Difference::possible_loss() const {
  if (change.mean == 0 && !change.half) return 0;
  return std::max(0.0, loss() + change.half.value_or(std::numeric_limits<double>::infinity()));
}

double Difference::loss() const {
  return better == scoring::Direction::higher ? -change.mean : change.mean;
}

double Difference::margin() const {
  return kMargin * scoring::least_change(scoring::metric(metric).scale, before);
}

const char* Difference::real_word() const {
  return verdict == Change::regressed || verdict == Change::improved ? word_of(verdict) : "";
}

std::vector<const Difference*> Comparison::with(Change verdict) const {
  std::vector<const Difference*> found;
  for (const Difference& difference : differences) {
    if (difference.verdict == verdict) found.push_back(&difference);
  }
  return found;
}

int Comparison::count_means(Change verdict) const {
  return static_cast<int>(std::ranges::count(groups, verdict, &Difference::verdict));
}

std::string Comparison::note() const {
  std::string text;
  const auto singles = std::ranges::count_if(differences, [](const Difference& difference) {
    return difference.better != scoring::Direction::neutral && !difference.change.half;
  });
  if (const auto known = judged - static_cast<int>(singles); known > 0) {
    text += fmt::format(
        "each figure of a single scenario is judged by its own interval: of {}, chance alone "
        "changes up to {}",
        known, (known + 19) / 20);
  }
  if (singles > 0) {
    text += fmt::format(
        "{}single scenarios with one seed have an unknown noise and no verdict; --seeds gives more",
        text.empty() ? "" : "; ");
  }
  return text;
}

std::optional<Change> Comparison::of_scenario(const std::string& name) const {
  if (lost.contains(name)) return Change::regressed;
  std::set<Change> verdicts;
  for (const Difference& difference : differences) {
    if (difference.scenario == name) verdicts.insert(difference.verdict);
  }
  for (const Change worst : {Change::regressed, Change::unknown, Change::improved}) {
    if (verdicts.contains(worst)) return worst;
  }
  return verdicts.empty() ? std::nullopt : std::optional(Change::none);
}

bool Comparison::has_regressed() const {
  return !lost.empty() || std::ranges::any_of(groups, [](const Difference& mean) {
    return mean.is_main && mean.verdict == Change::regressed;
  });
}

Finding Comparison::finding(int failed_criteria) const {
  if (has_regressed()) return Finding::regressed;
  const bool is_judged = std::ranges::any_of(groups, &Difference::is_main);
  if (!is_judged || !missing.empty()) return Finding::not_judged;
  const bool is_excluded = std::ranges::none_of(groups, [](const Difference& mean) {
    return mean.verdict == Change::regressed ||
           (mean.is_main && mean.possible_loss() > mean.margin());
  });
  const bool all_stand = failed_criteria == 0 && undefined == 0 && with(Change::regressed).empty();
  return is_excluded && all_stand ? Finding::equal : Finding::uncertain;
}

namespace {

/// Such as "a loss of up to 0.063 of rebel.f1 and 3.1 of rebel.false_corners_per_frame is not
/// excluded (some 590 worlds would tell 0.02 apart)"; empty if none is larger than its margin.
std::string losses_text(const Comparison& comparison) {
  std::vector<std::string> losses;
  const Difference* widest = nullptr;
  // How many times as many runs would have an interval of the margin, with enough of them for the
  // normal distribution.
  const auto times = [](const Difference& mean) {
    constexpr double kNormal95 = 1.96;
    return std::max(2.0, std::pow(kNormal95 * mean.change.error / mean.margin(), 2));
  };
  for (const Difference& mean : comparison.groups) {
    if (!mean.is_main || mean.possible_loss() <= mean.margin()) continue;
    losses.push_back(mean.change.half
                         ? fmt::format("{} of {}", number(mean.possible_loss()), mean.metric)
                         : fmt::format("any size of {}, whose noise is unknown", mean.metric));
    if (widest == nullptr || times(mean) > times(*widest)) widest = &mean;
  }
  if (losses.empty()) return "";
  const std::string text =
      fmt::format("a loss of up to {} is not excluded", fmt::join(losses, ", "));
  if (!widest->change.half) return text;
  const double more = times(*widest);
  return text + fmt::format(" ({} would tell {:.2g} of {} apart)",
                            comparison.is_of_worlds
                                ? fmt::format("some {:.0f} worlds", more * widest->pairs)
                                : fmt::format("some {:.0f} times as many seeds", std::ceil(more)),
                            widest->margin(), widest->metric);
}

}  // namespace

std::string text_of(Finding finding, const Comparison& comparison, int failed_criteria) {
  std::vector<std::string> parts;
  const auto add_count = [&](std::ptrdiff_t count, const char* noun, const char* what) {
    if (count > 0) parts.push_back(fmt::format("{} {}", counted(count, noun), what));
  };
  const auto regressed = [&](bool main) {
    return std::ranges::count_if(comparison.groups, [&](const Difference& mean) {
      return mean.is_main == main && mean.verdict == Change::regressed;
    });
  };
  switch (finding) {
    case Finding::regressed:
      for (const Difference& mean : comparison.groups) {
        if (!mean.is_main || mean.verdict != Change::regressed) continue;
        parts.push_back(fmt::format("{} {}", mean.metric, change_text(mean)));
      }
      add_count(std::ssize(comparison.lost), "scenario", "lost a run by an error");
      break;
    case Finding::not_judged:
      if (comparison.missing.empty()) {
        parts.emplace_back("no main figure is in both suites");
      } else {
        parts.push_back(fmt::format(
            "missing or other frames than before: {}{}; --allow-missing judges the others",
            comparison.missing.front(),
            comparison.missing.size() > 1
                ? fmt::format(" and {} more", comparison.missing.size() - 1)
                : ""));
      }
      break;
    case Finding::uncertain:
      if (std::string losses = losses_text(comparison); !losses.empty()) {
        parts.push_back(std::move(losses));
      }
      add_count(regressed(false), "other mean", "regressed");
      add_count(std::ranges::count_if(comparison.scenarios,
                                      [&](const auto& name) {
                                        return comparison.of_scenario(name) == Change::regressed;
                                      }),
                "scenario", "regressed");
      if (failed_criteria > 0) {
        parts.push_back(fmt::format("failed criteria and runs: {}", failed_criteria));
      }
      add_count(comparison.undefined, "main figure", "of a scenario is no longer defined");
      return fmt::format("{}, but {}", word_of(finding), fmt::join(parts, ", "));
    case Finding::equal:
      for (const Difference& mean : comparison.groups) {
        if (!mean.is_main) continue;
        parts.push_back(fmt::format("{} of {}", number(mean.possible_loss()), mean.metric));
      }
      return fmt::format("{}: no loss above {}", word_of(finding), fmt::join(parts, ", "));
  }
  return fmt::format("{}: {}", word_of(finding), fmt::join(parts, ", "));
}

Comparison compare(const SuiteResult& before, const SuiteResult& after,
                   const std::function<bool(std::string_view metric)>& is_wanted) {
  if (!after.sequential || !after.sequential->is_stopped()) {
    return Comparer(before, after, is_wanted).compare();
  }
  std::set<RunName> made;
  for (const ScenarioResult& scenario : after.scenarios) {
    for (const RunResult& run : scenario.runs) made.emplace(scenario.name, run.seed);
  }
  return Comparer(with_runs(before, made), after, is_wanted).compare();
}

std::vector<const Difference*> shown_means(const Comparison& comparison, bool all) {
  const auto largest = std::ranges::max_element(comparison.groups, {}, &Difference::pairs);
  const std::vector<std::string_view> tabled = scoring::keys_in(scoring::Table::suite);
  std::vector<const Difference*> shown;
  for (const Difference& mean : comparison.groups) {
    const bool is_main = mean.scenario == largest->scenario
                             ? std::ranges::find(tabled, mean.metric) != tabled.end()
                             : mean.metric == scoring::kF1;
    if (all || is_main || *mean.real_word() != 0) shown.push_back(&mean);
  }
  return shown;
}

std::string means_text(const Comparison& comparison, bool all, scoring::Format format) {
  const auto shown = shown_means(comparison, all);
  if (format != scoring::Format::text || shown.empty()) return table_of(shown, true, format);
  return fmt::format("means over so many scenarios, with the {:.3g} % interval of each change:\n{}",
                     100 * (1 - comparison.level), table_of(shown, true, format));
}

std::string text_of(const Comparison& comparison, bool all, scoring::Format format) {
  std::vector<const Difference*> singles;
  for (const Change change :
       {Change::regressed, Change::improved, Change::unknown, Change::moved, Change::none}) {
    if (change == Change::moved && !all) break;
    const std::vector<const Difference*> found = comparison.with(change);
    singles.insert(singles.end(), found.begin(), found.end());
  }
  std::string text = means_text(comparison, all, format);
  if (!text.empty() && !singles.empty()) text += '\n';
  text += table_of(singles, false, format);
  if (format != scoring::Format::text) return text;
  if (!comparison.incomparable.empty()) {
    text += "not compared:\n";
    for (const std::string& what : comparison.incomparable) text += fmt::format("  {}\n", what);
  }
  if (const std::string note = comparison.note(); !note.empty()) text += note + '\n';
  return text;
}

std::string change_text(const Difference& difference) {
  std::string text = fmt::format("{} -> {}", number(difference.before), number(difference.after));
  const auto& [mean, half, error, degrees_of_freedom] = difference.change;
  if (half)
    text += fmt::format(" [{}, {}]", signed_number(mean - *half), signed_number(mean + *half));
  return text;
}

}  // namespace lcs::suite
