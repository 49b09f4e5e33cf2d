#include "tools/scoring/criteria.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <iterator>
#include <map>
#include <optional>

#include "tools/input/spelling.h"
#include "tools/scoring/metrics.h"

namespace lcs::bench {
namespace {

std::string place(const input::Source& source) {
  return source.line > 0 ? fmt::format("{}:{}", source.file, source.line) : source.file;
}

std::string bounds(const scenario::Criterion& criterion) {
  std::string text;
  if (criterion.min) text += fmt::format("at least {}", *criterion.min);
  if (criterion.min && criterion.max) text += " and ";
  if (criterion.max) text += fmt::format("at most {}", *criterion.max);
  return text;
}

bool is_met(const scenario::Criterion& criterion, std::optional<double> figure) {
  return figure && (!criterion.min || *figure >= *criterion.min) &&
         (!criterion.max || *figure <= *criterion.max);
}

}  // namespace

void require_known_metrics(const std::vector<scenario::Criterion>& criteria) {
  std::vector<std::string> names;
  for (const Metric& metric : metrics()) {
    if (metric.compute) names.push_back(metric.key);
  }
  for (const scenario::Criterion& criterion : criteria) {
    if (std::find(names.begin(), names.end(), criterion.metric) != names.end()) continue;
    const std::optional<std::string> near = input::nearest(criterion.metric, names);
    throw input::Error(criterion.source,
                       fmt::format("no metric is called '{}'; {}", criterion.metric,
                                   near ? fmt::format("did you mean '{}'?", *near)
                                        : "tools/scoring/SCORING.md names them all"));
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
      places[criterion.detector].push_back(place(criterion.source));
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

std::vector<JudgedCriterion> judge(const std::vector<scenario::Criterion>& criteria,
                                   const Metrics& metrics) {
  std::vector<JudgedCriterion> judged;
  for (const scenario::Criterion& criterion : criteria) {
    const std::optional<double> figure = value(metrics, criterion.metric);
    const bool met = is_met(criterion, figure);
    JudgedCriterion& one = judged.emplace_back(JudgedCriterion{
        criterion.metric, criterion.min, criterion.max, figure, criterion.required, met, ""});
    if (met) continue;
    const std::string of = criterion.detector.empty() ? "" : " of " + criterion.detector;
    one.message =
        fmt::format("{}: {}{} is {}, must be {}", place(criterion.source), criterion.metric, of,
                    figure ? fmt::format("{:.4g}", *figure) : "undefined", bounds(criterion));
  }
  return judged;
}

}  // namespace lcs::bench
