#include "tools/scoring/criteria.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>
#include <map>

#include "scenarios/input/spelling.h"
#include "tools/scoring/metrics.h"

namespace lcs::scoring {

std::string bounds(std::optional<double> min, std::optional<double> max) {
  std::string text;
  if (min) text += fmt::format("at least {}", *min);
  if (min && max) text += " and ";
  if (max) text += fmt::format("at most {}", *max);
  return text;
}

void require_known_metrics(const std::vector<scenario::Criterion>& criteria) {
  std::vector<std::string> names;
  for (const Metric& metric : metrics()) {
    if (metric.compute) names.push_back(metric.key);
  }
  for (const scenario::Criterion& criterion : criteria) {
    if (std::ranges::find(names, criterion.metric) != names.end()) continue;
    const std::optional<std::string> near = input::nearest(criterion.metric, names);
    throw input::Error(criterion.source, "no metric is called '{}'; {}", criterion.metric,
                       near ? fmt::format("did you mean '{}'?", *near)
                            : "tools/scoring/SCORING.md names them all");
  }
}

std::vector<scenario::Criterion> asked_of(const std::string& detector, bool is_own,
                                          const std::vector<scenario::Criterion>& criteria) {
  std::vector<scenario::Criterion> asked;
  std::ranges::copy_if(criteria, std::back_inserter(asked), [&](const auto& criterion) {
    return criterion.detector == detector || (is_own && criterion.detector.empty());
  });
  return asked;
}

std::vector<std::string> not_asked(const std::vector<scenario::Criterion>& criteria,
                                   const std::set<std::string>& detectors) {
  std::map<std::string, std::vector<std::string>> places;  // by detector's name
  for (const scenario::Criterion& criterion : criteria) {
    if (!criterion.detector.empty() && !detectors.contains(criterion.detector)) {
      places[criterion.detector].push_back(text_of(criterion.source));
    }
  }
  std::vector<std::string> lines;
  for (const auto& [detector, at] : places) {
    lines.push_back(fmt::format("not asked: criteria of {} ({}{}); let it watch, by --beside",
                                detector, at.front(),
                                at.size() > 1 ? fmt::format(", the first of {}", at.size()) : ""));
  }
  return lines;
}

std::vector<std::string> not_judged(const std::vector<scenario::Criterion>& criteria) {
  const auto found =
      std::ranges::find_if(criteria, [](const auto& one) { return one.over != "seed"; });
  if (found == criteria.end()) return {};
  return {fmt::format("not judged: criteria over seeds, as at {}; lcs suite judges them",
                      text_of(found->source))};
}

std::vector<JudgedCriterion> judge(const std::vector<scenario::Criterion>& criteria,
                                   const Metrics& metrics) {
  std::vector<JudgedCriterion> judged;
  for (const scenario::Criterion& criterion : criteria) {
    const std::optional<double> figure = value(metrics, criterion.metric);
    const bool met = figure && (!criterion.min || *figure >= *criterion.min) &&
                     (!criterion.max || *figure <= *criterion.max);
    JudgedCriterion& one =
        judged.emplace_back(JudgedCriterion{.metric = criterion.metric,
                                            .min = criterion.min,
                                            .max = criterion.max,
                                            .value = figure,
                                            .required = criterion.required,
                                            .met = met || criterion.over != "seed",
                                            .over = criterion.over,
                                            .place = text_of(criterion.source)});
    if (one.met) continue;
    const std::string of = criterion.detector.empty() ? "" : " of " + criterion.detector;
    one.message = fmt::format("{}: {}{} is {}, must be {}", one.place, criterion.metric, of,
                              figure ? fmt::format("{:.4g}", *figure) : "undefined",
                              bounds(criterion.min, criterion.max));
  }
  return judged;
}

}  // namespace lcs::scoring
