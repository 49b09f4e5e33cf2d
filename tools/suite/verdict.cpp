#include "tools/suite/verdict.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <limits>
#include <map>
#include <ranges>
#include <set>
#include <utility>

#include "filter/types/reason.h"
#include "tools/scoring/events.h"
#include "tools/scoring/metrics.h"
#include "tools/suite/judgement.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

/// Limit of figures that a remark names; it only counts the others.
constexpr std::ptrdiff_t kMostFigures = 4;

/// New corners of a rule are not named as a reason up to this many or a twentieth of the earlier.
constexpr int kLeastNew = 2;

constexpr std::array<const char*, 6> kStandings{"error",   "failed",   "regressed",
                                                "changed", "improved", "passed"};

// ---- Rules

/// The sums of a run's events; absent if it has none or they are unreadable, as they only explain.
std::optional<scoring::EventSums> event_sums_of(const SuiteInFolder& suite, const RunResult& run) {
  const fs::path file = suite.events_of(run);
  if (file.empty()) return std::nullopt;
  try {
    return scoring::read_event_sums(file);
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
  const auto was = [&](Cause reason) { return before.contains(reason) ? before.at(reason) : 0; };
  int most = 0;
  for (const auto& [reason, corners] : after) {
    const int least = std::max(kLeastNew, was(reason) / 20);
    if (corners - was(reason) <= std::max(most, least)) continue;
    most = corners - was(reason);
    worst = reason;
  }
  if (!worst) return;
  const auto& text = text_of(*worst);
  int all = 0;
  for (const auto& [reason, count] : after) all += count;
  const std::string counts = has_before
                                 ? fmt::format("{} -> {} {}", was(*worst), after.at(*worst), unit)
                                 : fmt::format("{} of {} {}", after.at(*worst), all, unit);
  reasons.push_back(fmt::format("most {}{} by {} ({}): {}", has_before ? "new " : "", what,
                                text.word, text.meaning, counts));
}

/// Adds the rules behind the wrong verdicts. With a baseline, counts only runs of both suites.
void add_rules(const SuiteInFolder& after, const SuiteInFolder* before,
               const ScenarioResult& scenario, std::vector<std::string>& reasons) {
  scoring::EventSums now, then;
  const ScenarioResult* other = before ? find(before->suite, scenario.name) : nullptr;
  bool has_before = false;
  for (const RunResult& run : scenario.runs) {
    const RunResult* same = other ? find(*other, run.seed) : nullptr;
    const auto events = event_sums_of(after, run);
    const auto former = same ? event_sums_of(*before, *same) : std::nullopt;
    if (!events || (before && !former)) continue;
    now.add(*events);
    if (former) then.add(*former);
    has_before |= former.has_value();
  }
  // Such a mover moves as a static body at another depth does, which no rule of a corner tells.
  constexpr double kMuch = 0.1;
  const auto radial = over_seeds(scenario, "rebel.f1_lost_radial");
  if (radial && radial->mean > kMuch) {
    reasons.push_back(fmt::format(
        "{:.2f} of F1 lost on radial corners: on a mover along the line of sight", radial->mean));
  }
  add_rule(now.missed, then.missed, has_before, "misses", "corners", reasons);
  add_rule(now.false_ones, then.false_ones, has_before, "false rebels", "corners", reasons);
  add_rule(now.squares, then.squares, has_before, "wrong squares", "object-frames", reasons);
}

// ---- The line

/// \param finding absent without a comparison.
std::string line_of(const SuiteResult& suite, const Comparison* comparison,
                    const std::optional<Finding>& finding, const CriteriaCounts& criteria) {
  if (!finding) return text_of(criteria);
  std::map<std::optional<Change>, int> count;
  for (const std::string& name : comparison->scenarios) ++count[comparison->of_scenario(name)];
  const std::set<std::string> common(comparison->scenarios.begin(), comparison->scenarios.end());
  for (const ScenarioResult& scenario : suite.scenarios) {
    count[std::nullopt] += !common.contains(scenario.name);
  }
  std::string line = fmt::format(
      "{}; of {} {} regressed, {} improved; of {} {} regressed, {} improved, {} as before",
      text_of(*finding, *comparison, criteria.unmet()), counted(comparison->judged_means, "mean"),
      comparison->count_means(Change::regressed), comparison->count_means(Change::improved),
      counted(std::ssize(suite.scenarios), "scenario"), count[Change::regressed],
      count[Change::improved], count[Change::none]);
  if (const auto& looked = suite.sequential; looked && looked->is_stopped()) {
    line += fmt::format(", after {} of {} runs (--all makes them all)", looked->look.runs,
                        looked->planned);
  }
  if (count[Change::unknown] > 0) line += fmt::format(", {} unknown", count[Change::unknown]);
  if (count[std::nullopt] > 0) line += fmt::format(", {} not compared", count[std::nullopt]);
  return fmt::format("{}; {}", line, text_of(criteria));
}

Light light_of(const std::optional<Finding>& finding, int unmet) {
  if (!finding) return unmet > 0 ? Light::red : Light::green;
  constexpr std::array<Light, 4> kByFinding{Light::red, Light::red, Light::yellow, Light::green};
  return kByFinding.at(static_cast<std::size_t>(*finding));
}

// ---- Remarks

struct Weighed {
  Remark remark;
  double weight = 0;  // orders remarks with the same worst standing
  Standing worst() const { return *std::ranges::min_element(remark.standings); }
};

void add_changes(const Comparison& comparison, const std::string& scenario, Change verdict,
                 Weighed& to) {
  std::vector<const Difference*> found = comparison.with(verdict);
  std::erase_if(found, [&](const Difference* one) { return one->scenario != scenario; });
  // F1 comes first, even if another figure changed by more
  const auto weight = [](const Difference* one) {
    return one->metric == scoring::kF1 ? std::numeric_limits<double>::infinity() : one->weight;
  };
  std::ranges::stable_sort(found, std::greater(), weight);
  for (const Difference* one : found) to.weight = std::max(to.weight, one->weight);
  for (const Difference* one : std::span(found).first(
           static_cast<std::size_t>(std::min(std::ssize(found), kMostFigures)))) {
    to.remark.reasons.push_back(fmt::format("{} {}", one->metric, change_text(*one)));
  }
  if (std::ssize(found) > kMostFigures) {
    to.remark.reasons.push_back(
        fmt::format("and {}", counted(std::ssize(found) - kMostFigures, "more figure")));
  }
}

/// Adds the failed criteria. A criterion that fails with several seeds is stated once.
void add_failed_criteria(const ScenarioResult& scenario, Weighed& to) {
  std::map<std::size_t, std::vector<const RunResult*>> failed;  // by the criterion's index
  int count = 0;
  for (const RunResult& run : scenario.runs) {
    for (std::size_t i = 0; i < run.criteria.size(); ++i) {
      if (run.criteria[i].met || !run.criteria[i].required) continue;
      failed[i].push_back(&run);
      ++count;
    }
  }
  for (const auto& [i, runs] : failed) {
    const scoring::JudgedCriterion& criterion = runs.front()->criteria[i];
    const bool is_of_run = criterion.over == "seed";
    std::string reason = "failed criterion, ";
    if (is_of_run) reason += fmt::format("seed {}, ", runs.front()->seed);
    reason += criterion.message;
    if (is_of_run && runs.size() > 1) {
      reason += fmt::format(" (fails with {} of {} seeds)", runs.size(), scenario.runs.size());
    }
    to.remark.reasons.push_back(std::move(reason));
  }
  to.weight = std::max<double>(to.weight, count);
}

/// \return nothing if the scenario passed and is as before.
std::optional<Weighed> weighed(const SuiteInFolder& after, const SuiteInFolder* before,
                               const Comparison* comparison, const ScenarioResult& scenario) {
  Weighed found{.remark = {scenario.name, standings_of(scenario, comparison), {}}};
  const Standing worst = found.worst();
  if (worst == Standing::passed) return std::nullopt;
  std::set<std::string> told;
  for (const RunResult& run : scenario.runs) {
    if (run.outcome == Outcome::error && told.insert(run.error).second) {
      found.remark.reasons.push_back(fmt::format("seed {}: {}", run.seed, run.error));
    }
  }
  add_failed_criteria(scenario, found);
  if (comparison) {
    add_changes(*comparison, scenario.name, Change::regressed, found);
    add_changes(*comparison, scenario.name, Change::unknown, found);
  }
  if (worst == Standing::improved) {
    add_changes(*comparison, scenario.name, Change::improved, found);
  } else {
    // Without a loss all misses count, not only new ones.
    const Standing last = found.remark.standings.back();
    const bool has_changed = last == Standing::regressed || last == Standing::changed;
    add_rules(after, has_changed ? before : nullptr, scenario, found.remark.reasons);
  }
  return found;
}

}  // namespace

fs::path SuiteInFolder::events_of(const RunResult& run) const {
  if (folder.empty() || run.folder.empty()) return {};
  fs::path file = folder / run.folder / scoring::kEventsFile;
  return fs::exists(file) ? file : fs::path();
}

std::vector<Standing> standings_of(const ScenarioResult& scenario, const Comparison* comparison) {
  constexpr std::array<Standing, 3> kByOutcome{Standing::passed, Standing::failed, Standing::error};
  std::vector standings{kByOutcome.at(static_cast<std::size_t>(outcome_of(scenario)))};
  const auto change = comparison ? comparison->of_scenario(scenario.name) : std::nullopt;
  if (change == Change::regressed) standings.push_back(Standing::regressed);
  if (change == Change::unknown) standings.push_back(Standing::changed);
  if (change == Change::improved) standings.push_back(Standing::improved);
  return standings;
}

SuiteVerdict verdict_of(const SuiteInFolder& after, const SuiteInFolder* before,
                        const Comparison* comparison, std::span<const SuiteResult> others) {
  std::vector<Weighed> all;
  for (const ScenarioResult& scenario : after.suite.scenarios) {
    if (auto found = weighed(after, before, comparison, scenario)) {
      all.push_back(std::move(*found));
    }
  }
  std::ranges::stable_sort(all, {},
                           [](const Weighed& one) { return std::pair(one.worst(), -one.weight); });
  const CriteriaCounts criteria = count_criteria(judgements_of(after.suite, others));
  std::optional<Finding> finding;
  if (comparison) finding = comparison->finding(criteria.unmet());
  SuiteVerdict verdict{.finding = finding,
                       .line = line_of(after.suite, comparison, finding, criteria),
                       .light = light_of(finding, criteria.unmet()),
                       .note = comparison ? comparison->note() : ""};
  for (Weighed& one : all) verdict.remarks.push_back(std::move(one.remark));
  return verdict;
}

std::string text_of(const SuiteVerdict& verdict) {
  std::string text;
  for (const Remark& remark : verdict.remarks) {
    text += fmt::format("{}: {}\n", text_of(remark.standings), remark.scenario);
    for (const std::string& reason : remark.reasons) text += fmt::format("  {}\n", reason);
  }
  if (!verdict.note.empty()) text += verdict.note + '\n';
  return text;
}

std::string text_of(const std::vector<Standing>& standings) {
  const auto word = [](Standing standing) { return word_of(standing); };
  return fmt::format("{}", fmt::join(standings | std::views::transform(word), ", "));
}

const char* word_of(Light light) {
  constexpr std::array<const char*, 3> kWords{"red", "yellow", "green"};
  return kWords.at(static_cast<std::size_t>(light));
}

const char* word_of(Standing standing) {
  return kStandings.at(static_cast<std::size_t>(standing));
}

}  // namespace lcs::suite
