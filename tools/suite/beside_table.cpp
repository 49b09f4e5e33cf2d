#include "tools/suite/beside_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <string_view>
#include <vector>

#include "tools/bench/statistics.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

constexpr std::string_view kF1 = "rebel.f1", kTime = "time.filter_ms_median";

/// A scenario's figure by each detector, the suite's own first.
struct Row {
  std::string name;
  std::vector<double> figures;
};

/// Scenarios that have the figure by every detector.
std::vector<Row> rows_of(const SuiteResult& suite, std::span<const SuiteResult> others,
                         std::string_view name) {
  std::vector<Row> rows;
  for (const ScenarioResult& scenario : suite.scenarios) {
    Row row{scenario.name, {}};
    const auto add = [&](const SuiteResult& by) {
      if (const auto value = mean_over_seeds(by, scenario.name, name))
        row.figures.push_back(*value);
    };
    add(suite);
    for (const SuiteResult& other : others) add(other);
    if (row.figures.size() == 1 + others.size()) rows.push_back(row);
  }
  return rows;
}

Row mean_of(const std::vector<Row>& rows, std::string_view of) {
  Row mean{fmt::format("= {} ({})", of, rows.size()), rows.front().figures};
  for (std::size_t d = 0; d < mean.figures.size(); ++d) {
    std::vector<double> column;
    for (const Row& row : rows) column.push_back(row.figures[d]);
    mean.figures[d] = bench::mean(column).value();
  }
  return mean;
}

/// Means over the groups that some of the scenarios are in, and over all.
std::vector<Row> means_of(const SuiteResult& suite, const std::vector<Row>& rows) {
  std::vector<Row> means;
  for (const std::string& group : groups_of(suite)) {
    std::vector<Row> of_group;
    for (const Row& row : rows) {
      const auto& groups = find(suite, row.name)->groups;
      if (std::find(groups.begin(), groups.end(), group) != groups.end()) of_group.push_back(row);
    }
    if (!of_group.empty() && of_group.size() < rows.size()) {
      means.push_back(mean_of(of_group, group));
    }
  }
  means.push_back(mean_of(rows, "mean"));
  return means;
}

/// The suite's detector beside the one in a column.
std::string summary_line(const SuiteResult& suite, const SuiteResult& other,
                         const std::vector<Row>& rows, const std::vector<Row>& times,
                         std::size_t column) {
  const auto ahead = [&](const Row& row) { return row.figures[0] - row.figures[column]; };
  const auto count =
      std::count_if(rows.begin(), rows.end(), [&](const Row& row) { return ahead(row) > 0; });
  const Row& least = *std::min_element(
      rows.begin(), rows.end(), [&](const Row& a, const Row& b) { return ahead(a) < ahead(b); });
  std::string line =
      fmt::format("{} is ahead of {} in {} of {}, least in {} ({:+.3f})", suite.detector,
                  other.detector, count, rows.size(), least.name, ahead(least));
  std::vector<double> ratios;
  for (const Row& row : times) {
    if (row.figures[column] > 0) ratios.push_back(row.figures[0] / row.figures[column]);
  }
  if (const auto ratio = bench::mean(ratios))
    line += fmt::format("; takes {:.2f} of its time", *ratio);
  return line + '\n';
}

}  // namespace

std::string beside_table(const SuiteResult& suite, std::span<const SuiteResult> others) {
  std::vector<Row> rows = rows_of(suite, others, kF1);
  if (rows.empty()) return "no scenario has an F1 by every detector\n";
  const std::vector<Row> times = rows_of(suite, others, kTime);
  std::string lines;
  for (std::size_t i = 0; i < others.size(); ++i) {
    lines += summary_line(suite, others[i], rows, times, i + 1);
  }
  const std::vector<Row> means = means_of(suite, rows);
  rows.insert(rows.end(), means.begin(), means.end());

  std::size_t longest = 0;
  for (const Row& row : rows) longest = std::max(longest, row.name.size());
  std::vector<std::string_view> names{suite.detector};
  for (const SuiteResult& other : others) names.push_back(other.detector);
  std::string text = fmt::format("{:<{}}", "F1", longest);
  for (const std::string_view name : names) text += fmt::format("  {:>5}", name);
  text += '\n';
  for (const Row& row : rows) {
    text += fmt::format("{:<{}}", row.name, longest);
    for (std::size_t d = 0; d < names.size(); ++d) {
      text += fmt::format("  {:>{}.2f}", row.figures[d], std::max<std::size_t>(5, names[d].size()));
    }
    text += '\n';
  }
  return text + lines;
}

}  // namespace lcs::suite
