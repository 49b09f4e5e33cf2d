#include "tools/suite/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <set>
#include <utility>

#include "filter/reason.h"
#include "tools/scoring/events.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

namespace fs = std::filesystem;

/// Limit of figures that a remark names; it only counts the others.
constexpr std::size_t kMostFigures = 4;

/// New corners of a rule are not named as a reason up to this many or a twentieth of the earlier.
constexpr int kLeastNew = 2;

constexpr std::array<const char*, 5> kStandings{"error", "failed", "regressed", "changed",
                                                "improved"};

// ---- Rules

/// The sums of a run's events; absent if it has none or they are unreadable, as they only explain.
std::optional<bench::EventSums> events_of(const SuiteInFolder& suite, const RunResult& run) {
  const fs::path file = suite.folder / run.folder / bench::kEventsFile;
  if (run.folder.empty() || !fs::exists(file)) return std::nullopt;
  try {
    return bench::read_event_sums(file);
  } catch (const std::exception&) {
    return std::nullopt;
  }
}

/// \param unit the counted unit. \param Cause has a `text_of` with word and meaning.
template <class Cause>
void add_rule(const std::map<Cause, int>& after, const std::map<Cause, int>& before,
              bool has_before, const char* what, const char* unit,
              std::vector<std::string>& reasons) {
  std::optional<Cause> worst;
  const auto was = [&](Cause reason) {
    const auto found = before.find(reason);
    return found == before.end() ? 0 : found->second;
  };
  int most = 0;
  for (const auto& [reason, corners] : after) {
    const int least = std::max(kLeastNew, was(reason) / 20);
    if (corners - was(reason) <= std::max(most, least)) continue;
    most = corners - was(reason);
    worst = reason;
  }
  if (!worst) return;
  const auto& text = text_of(*worst);
  reasons.push_back(has_before ? fmt::format("most new {} by {} ({}): {} -> {} {}", what, text.word,
                                             text.meaning, was(*worst), after.at(*worst), unit)
                               : fmt::format("most {} by {} ({}): {} {}", what, text.word,
                                             text.meaning, after.at(*worst), unit));
}

/// Adds the rules behind the wrong verdicts. With a baseline, counts only runs of both suites.
void add_rules(const SuiteInFolder& after, const SuiteInFolder* before,
               const ScenarioResult& scenario, std::vector<std::string>& reasons) {
  bench::EventSums now, then;
  const ScenarioResult* other = before ? find(before->suite, scenario.name) : nullptr;
  bool has_before = false;
  for (const RunResult& run : scenario.runs) {
    const RunResult* same = other ? find(*other, run.seed) : nullptr;
    const auto events = events_of(after, run);
    const auto former = same ? events_of(*before, *same) : std::nullopt;
    if (!events || (before && !former)) continue;
    now.add(*events);
    if (former) then.add(*former);
    has_before |= former.has_value();
  }
  add_rule(now.missed, then.missed, has_before, "misses", "corners", reasons);
  add_rule(now.false_ones, then.false_ones, has_before, "false rebels", "corners", reasons);
  add_rule(now.squares, then.squares, has_before, "wrong squares", "frames", reasons);
}

// ---- Criteria

/// Counts of the scenarios' criteria, which are the same in each run and in the same order.
struct CriteriaCount {
  int met = 0, missed = 0, missed_optional = 0, errors = 0;
};

CriteriaCount criteria_of(const SuiteResult& suite) {
  CriteriaCount count;
  for (const ScenarioResult& scenario : suite.scenarios) {
    std::size_t most = 0;
    for (const RunResult& run : scenario.runs) {
      most = std::max(most, run.criteria.size());
      count.errors += run.outcome == Outcome::error;
    }
    for (std::size_t i = 0; i < most; ++i) {
      bool required = false, met = true;
      for (const RunResult& run : scenario.runs) {
        if (i >= run.criteria.size()) continue;
        required |= run.criteria[i].required;
        met &= run.criteria[i].met;
      }
      ++(met ? count.met : required ? count.missed : count.missed_optional);
    }
  }
  return count;
}

std::string counted(int count, const char* one, const char* more) {
  return fmt::format("{} {}", count, count == 1 ? one : more);
}

std::string line_of(const SuiteResult& suite, const Comparison* comparison) {
  const CriteriaCount criteria = criteria_of(suite);
  std::string line;
  if (comparison) {
    std::map<std::optional<Change>, int> count;
    for (const std::string& name : comparison->scenarios) ++count[comparison->of_scenario(name)];
    std::set<std::string> common(comparison->scenarios.begin(), comparison->scenarios.end());
    for (const ScenarioResult& scenario : suite.scenarios) {
      count[std::nullopt] += !common.contains(scenario.name);
    }
    const auto counts = [](int worse, int better) {
      return fmt::format("{} regressed, {} improved", worse, better);
    };
    line = fmt::format(
        "{}: of {} means {}; of single scenarios {}, {} as before",
        comparison->has_regressed() ? "regressed" : "not regressed", comparison->judged_means,
        counts(comparison->count_means(Change::regressed),
               comparison->count_means(Change::improved)),
        counts(count[Change::regressed], count[Change::improved]), count[Change::none]);
    if (count[Change::unknown] > 0) line += fmt::format(", {} unknown", count[Change::unknown]);
    if (count[std::nullopt] > 0) line += fmt::format(", {} not compared", count[std::nullopt]);
    if (criteria.met + criteria.missed > 0) {
      line += fmt::format(", {}", counted(criteria.missed, "criterion missed", "criteria missed"));
    }
  } else if (criteria.met + criteria.missed + criteria.missed_optional > 0) {
    line = fmt::format("{}, {} missed", counted(criteria.met, "criterion met", "criteria met"),
                       criteria.missed);
  } else {
    line = "no criteria asked for";
  }
  if (criteria.missed_optional > 0) {
    line += fmt::format(", {} missed that {} not required", criteria.missed_optional,
                        criteria.missed_optional == 1 ? "is" : "are");
  }
  if (criteria.errors > 0) {
    line += fmt::format(
        ", {}", counted(criteria.errors, "run ended with an error", "runs ended with an error"));
  }
  return line;
}

// ---- Remarks

struct Weighed {
  Remark remark;
  double weight = 0;  // orders remarks of the same standing
};

void add_changes(const Comparison& comparison, const std::string& scenario, Change verdict,
                 Weighed& to) {
  std::vector<const Difference*> found;
  for (const Difference& difference : comparison.differences) {
    if (difference.scenario == scenario && difference.verdict == verdict) {
      found.push_back(&difference);
    }
  }
  // F1 comes first, even if another figure changed by more
  const auto weight = [](const Difference* one) {
    return one->metric == "rebel.f1" ? std::numeric_limits<double>::infinity() : one->weight;
  };
  std::stable_sort(found.begin(), found.end(),
                   [&](const auto* a, const auto* b) { return weight(a) > weight(b); });
  for (const Difference* one : found) to.weight = std::max(to.weight, one->weight);
  for (std::size_t i = 0; i < std::min(found.size(), kMostFigures); ++i) {
    to.remark.reasons.push_back(fmt::format("{} {}", found[i]->metric, change_text(*found[i])));
  }
  if (found.size() > kMostFigures) {
    to.remark.reasons.push_back(fmt::format(
        "and {}",
        counted(static_cast<int>(found.size() - kMostFigures), "more figure", "more figures")));
  }
}

/// Adds the missed required criteria. A criterion that several seeds miss is stated once.
void add_missed_criteria(const ScenarioResult& scenario, Weighed& to) {
  std::map<std::size_t, std::vector<const RunResult*>> missed;  // by the criterion's index
  int count = 0;
  for (const RunResult& run : scenario.runs) {
    for (std::size_t i = 0; i < run.criteria.size(); ++i) {
      if (run.criteria[i].met || !run.criteria[i].required) continue;
      missed[i].push_back(&run);
      ++count;
    }
  }
  for (const auto& [i, runs] : missed) {
    const bench::JudgedCriterion& criterion = runs.front()->criteria[i];
    const bool is_of_run = criterion.over == "seed";
    std::string reason = is_of_run
                             ? fmt::format("seed {}: {}", runs.front()->seed, criterion.message)
                             : criterion.message;
    if (is_of_run && runs.size() > 1) reason += fmt::format(" ({} seeds miss it)", runs.size());
    to.remark.reasons.push_back(std::move(reason));
  }
  to.weight = std::max<double>(to.weight, count);
}

std::optional<Weighed> weighed(const SuiteInFolder& after, const SuiteInFolder* before,
                               const Comparison* comparison, const ScenarioResult& scenario) {
  const Outcome outcome = outcome_of(scenario);
  Change change = Change::none;
  if (comparison) change = comparison->of_scenario(scenario.name).value_or(Change::none);
  Weighed found{.remark = {scenario.name, Standing::improved, {}}};
  if (outcome == Outcome::error) {
    found.remark.standing = Standing::error;
    std::set<std::string> told;
    for (const RunResult& run : scenario.runs) {
      if (run.outcome == Outcome::error && told.insert(run.error).second) {
        found.remark.reasons.push_back(fmt::format("seed {}: {}", run.seed, run.error));
      }
    }
  } else if (outcome == Outcome::failed) {
    found.remark.standing = Standing::failed;
  } else if (change == Change::regressed) {
    found.remark.standing = Standing::regressed;
  } else if (change == Change::unknown) {
    found.remark.standing = Standing::changed;
  } else if (change != Change::improved) {
    return std::nullopt;
  }
  if (comparison) {
    add_changes(*comparison, scenario.name, Change::regressed, found);
    add_changes(*comparison, scenario.name, Change::unknown, found);
  }
  add_missed_criteria(scenario, found);
  if (found.remark.standing != Standing::improved) {
    // without a change all misses count, not only new ones
    const bool has_changed = change == Change::regressed || change == Change::unknown;
    add_rules(after, has_changed ? before : nullptr, scenario, found.remark.reasons);
  } else {
    add_changes(*comparison, scenario.name, Change::improved, found);
  }
  return found;
}

}  // namespace

Verdict verdict_of(const SuiteInFolder& after, const SuiteInFolder* before,
                   const Comparison* comparison) {
  std::vector<Weighed> all;
  for (const ScenarioResult& scenario : after.suite.scenarios) {
    if (auto found = weighed(after, before, comparison, scenario)) {
      all.push_back(std::move(*found));
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Weighed& a, const Weighed& b) {
    return std::pair(a.remark.standing, -a.weight) < std::pair(b.remark.standing, -b.weight);
  });
  Verdict verdict{line_of(after.suite, comparison), comparison ? comparison->note() : "", {}};
  for (Weighed& one : all) verdict.remarks.push_back(std::move(one.remark));
  return verdict;
}

std::string text_of(const Verdict& verdict) {
  std::string text;
  for (const Remark& remark : verdict.remarks) {
    text += fmt::format("{}: {}\n", word_of(remark.standing), remark.scenario);
    for (const std::string& reason : remark.reasons) text += fmt::format("  {}\n", reason);
  }
  if (!verdict.note.empty()) text += verdict.note + '\n';
  return text + verdict.line + '\n';
}

const char* word_of(Standing standing) {
  return kStandings.at(static_cast<std::size_t>(standing));
}

}  // namespace lcs::suite
