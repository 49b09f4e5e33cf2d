#include "tools/suite/judgement.h"

#include <fmt/format.h>

#include <array>
#include <cctype>
#include <map>

#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

/// Names a criterion of a run, or one over seeds, without its bounds. Repeated names are numbered.
/// \param times how often a name is taken.
std::string name_of(const scoring::JudgedCriterion& criterion, std::map<std::string, int>& times) {
  std::string name = criterion.metric;
  if (criterion.min) name += " min";
  if (criterion.max) name += " max";
  if (!criterion.required) name += " (not required)";
  if (criterion.over != "seed") name += fmt::format(" of the {} over seeds", criterion.over);
  if (const int number = ++times[name]; number > 1) name += fmt::format(" #{}", number);
  return name;
}

void add(Judgement one, const scoring::JudgedCriterion& criterion, std::vector<Judgement>& all) {
  one.judged = criterion.met ? Judged::met : criterion.required ? Judged::failed : Judged::missed;
  one.message = criterion.message;
  one.is_of_criterion = true;
  all.push_back(std::move(one));
}

/// \param by "" for the suite's own detector, else such as "klt: ".
void add_run(const ScenarioResult& scenario, const RunResult& run, const std::string& by,
             std::vector<Judgement>& all) {
  Judgement one{.scenario = scenario.name,
                .file = scenario.file,
                .name = fmt::format("{}runs, seed {}", by, run.seed),
                .anchor = anchor_of(scenario.name, run.seed),
                .time_s = by.empty() ? run.wall_s : 0};
  if (run.outcome == Outcome::error || run.criteria.empty()) {
    if (run.outcome == Outcome::error) {
      one.judged = Judged::error;
      one.message = run.error;
    }
    all.push_back(std::move(one));
    return;
  }
  one.time_s /= static_cast<double>(run.criteria.size());
  std::map<std::string, int> times;
  for (const scoring::JudgedCriterion& criterion : run.criteria) {
    if (criterion.over != "seed") continue;
    one.name = fmt::format("{}{}, seed {}", by, name_of(criterion, times), run.seed);
    add(one, criterion, all);
  }
}

void add_over_seeds(const ScenarioResult& scenario, const ScenarioResult& judged,
                    const std::string& by, std::vector<Judgement>& all) {
  double time_s = 0;
  const RunResult* first = nullptr;
  for (const RunResult& run : judged.runs) {
    if (run.outcome == Outcome::error || run.criteria.empty()) continue;
    if (by.empty()) time_s += run.wall_s / static_cast<double>(run.criteria.size());
    first = first ? first : &run;
  }
  if (!first) return;
  std::map<std::string, int> times;
  for (const scoring::JudgedCriterion& criterion : first->criteria) {
    if (criterion.over == "seed") continue;
    add({.scenario = scenario.name,
         .file = scenario.file,
         .name = by + name_of(criterion, times),
         .anchor = anchor_of(scenario.name),
         .time_s = time_s},
        criterion, all);
  }
}

}  // namespace

std::vector<Judgement> judgements_of(const SuiteResult& suite,
                                     std::span<const SuiteResult> others) {
  std::vector<Judgement> all;
  for (const ScenarioResult& scenario : suite.scenarios) {
    for (const RunResult& run : scenario.runs) {
      add_run(scenario, run, "", all);
      for (const SuiteResult& other : others) {
        const ScenarioResult* by_other = find(other, scenario.name);
        const RunResult* found = by_other ? find(*by_other, run.seed) : nullptr;
        if (!found) continue;
        // One process runs all detectors, so that its error is told once.
        const bool is_new_error = found->outcome == Outcome::error && run.outcome != Outcome::error;
        if (is_new_error || !found->criteria.empty()) {
          add_run(scenario, *found, other.detector + ": ", all);
        }
      }
    }
    add_over_seeds(scenario, scenario, "", all);
    for (const SuiteResult& other : others) {
      const ScenarioResult* by_other = find(other, scenario.name);
      if (by_other) add_over_seeds(scenario, *by_other, other.detector + ": ", all);
    }
  }
  return all;
}

CriteriaCounts count_criteria(const std::vector<Judgement>& judgements) {
  CriteriaCounts counts;
  for (const Judgement& one : judgements) {
    counts.met += one.judged == Judged::met;
    counts.failed += one.judged == Judged::failed;
    counts.missed += one.judged == Judged::missed;
    counts.errors += one.judged == Judged::error;
    counts.has_criteria |= one.is_of_criterion;
  }
  return counts;
}

std::string text_of(const CriteriaCounts& counts) {
  std::string text;
  if (!counts.has_criteria) {
    text = fmt::format("{} without an error", counted(counts.met, "run"));
  } else {
    text = fmt::format("{} of {} criteria met, {} failed", counts.met, counts.all(), counts.failed);
    if (counts.missed > 0) text += fmt::format(", {} missed but not required", counts.missed);
  }
  if (counts.errors > 0) text += fmt::format(", {} with an error", counted(counts.errors, "run"));
  return counts.has_criteria ? text : text + ", no criteria asked for";
}

std::string run_counts(const SuiteResult& suite) {
  std::array<int, 3> counts{};
  int all = 0;
  for (const ScenarioResult& scenario : suite.scenarios) {
    for (const RunResult& run : scenario.runs) {
      ++counts[static_cast<std::size_t>(run.outcome)];
      ++all;
    }
  }
  const auto [passed, failed, errors] = counts;
  std::string text = fmt::format("{} of {}: {} passed, {} failed", counted(all, "run"),
                                 counted(std::ssize(suite.scenarios), "scenario"), passed, failed);
  return errors > 0 ? text + fmt::format(", {} with an error", errors) : text;
}

std::string counted(std::int64_t count, const std::string& noun) {
  return fmt::format("{} {}{}", count, noun, count == 1 ? "" : "s");
}

std::string address_of(std::string_view path) {
  constexpr std::string_view kPlain = "-._~!$&'()*+,;=@/";
  std::string address;
  for (const char c : path) {
    const auto byte = static_cast<unsigned char>(c);
    const bool is_plain = byte < 128 && (std::isalnum(byte) || kPlain.find(c) != kPlain.npos);
    address += is_plain ? std::string(1, c) : fmt::format("%{:02X}", byte);
  }
  return address;
}

std::string anchor_of(const std::string& scenario) {
  return address_of(scenario);
}

std::string anchor_of(const std::string& scenario, std::uint64_t seed) {
  return fmt::format("{}/seed-{}", address_of(scenario), seed);
}

}  // namespace lcs::suite
