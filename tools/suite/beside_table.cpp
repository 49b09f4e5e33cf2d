#include "tools/suite/beside_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "tools/scoring/metrics.h"
#include "tools/scoring/statistics.h"
#include "tools/suite/interval.h"
#include "tools/suite/judgement.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

constexpr std::string_view kTime = "time.filter_ms_median";
constexpr std::array<std::string_view, 2> kFalse{"rebel.false_corners_per_frame",
                                                 "rebel.false_objects_per_100_frames"};

constexpr const char* kIntervalLegend =
    "±: 95 % interval of the mean over worlds; ahead: by world, and then the mean\n";

/// A scenario's figure for each detector, the suite's own first.
struct Row {
  std::string name;
  std::vector<double> figures;
};

/// The mean figure of each detector over several scenarios.
struct MeanRow {
  std::string name;
  std::vector<Interval> means;
};

/// A row for each scenario in which the figure is defined for every detector.
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

MeanRow mean_of(const std::vector<Row>& rows, std::string_view of) {
  MeanRow mean{fmt::format("= {} ({})", of, rows.size()), {}};
  for (std::size_t d = 0; d < rows.front().figures.size(); ++d) {
    std::vector<double> column;
    for (const Row& row : rows) column.push_back(row.figures[d]);
    mean.means.push_back(interval_of(column));
  }
  return mean;
}

/// The means over each group that is not empty and not everything, and over all; none without rows.
/// \param but leaves out the groups that have one of these rows; the group of all may then be
/// there.
std::vector<MeanRow> means_of(const SuiteResult& suite, const std::vector<Row>& rows,
                              const std::optional<std::vector<Row>>& but = {}) {
  std::vector<MeanRow> means;
  if (rows.empty()) return means;
  for (const std::string& group : groups_of(suite)) {
    const auto is_of_group = [&](const Row& row) { return is_in(*find(suite, row.name), group); };
    std::vector<Row> of_group;
    std::ranges::copy_if(rows, std::back_inserter(of_group), is_of_group);
    const bool is_left_out =
        but ? std::ranges::any_of(*but, is_of_group) : of_group.size() == rows.size();
    if (!of_group.empty() && !is_left_out) means.push_back(mean_of(of_group, group));
  }
  means.push_back(mean_of(rows, "mean"));
  return means;
}

/// Replaces the figures by the suite's own figure minus each detector's.
std::vector<Row> leads(std::vector<Row> rows) {
  for (Row& row : rows) {
    const double own = row.figures.front();
    for (double& figure : row.figures) figure = own - figure;
  }
  return rows;
}

/// Formats rows of figures below a header of the detectors' names.
class Columns {
 public:
  Columns(std::size_t name_width, std::vector<std::string> names, bool with_intervals)
      : name_width_(name_width), names_(std::move(names)), half_width_(with_intervals ? 5 : 0) {}

  void header(std::string_view figure, std::size_t first = 0) {
    text_ += fmt::format("{:<{}}", figure, name_width_);
    for (std::size_t d = 0; d < names_.size(); ++d) {
      text_ += fmt::format("  {:>{}}{:{}}", d < first ? "" : names_[d], width(d), "", half_width_);
    }
    end();
  }
  void row(const Row& row) {
    text_ += fmt::format("{:<{}}", row.name, name_width_);
    for (std::size_t d = 0; d < names_.size(); ++d) cell({row.figures[d], {}}, d, 2, false);
    end();
  }
  void row(const MeanRow& row, int decimals, std::size_t first = 0) {
    text_ += fmt::format("{:<{}}", row.name, name_width_);
    for (std::size_t d = 0; d < names_.size(); ++d) {
      if (d < first) {
        text_ += fmt::format("  {:{}}", "", width(d) + half_width_);
      } else {
        cell(row.means[d], d, decimals, first > 0);
      }
    }
    end();
  }
  const std::string& text() const { return text_; }

 private:
  std::size_t width(std::size_t d) const {
    return std::max<std::size_t>(half_width_ > 0 ? 6 : 5, names_[d].size());
  }
  void cell(const Interval& mean, std::size_t d, int decimals, bool is_signed) {
    const std::string number = is_signed ? fmt::format("{:+.{}f}", mean.mean, decimals)
                                         : fmt::format("{:.{}f}", mean.mean, decimals);
    text_ += fmt::format("  {:>{}}", number, width(d));
    if (half_width_ > 0) {
      text_ += fmt::format("{:<{}}", half_text(mean.half.value_or(0), decimals), half_width_);
    }
  }
  void end() {
    while (text_.ends_with(' ')) text_.pop_back();
    text_ += '\n';
  }

  std::size_t name_width_;
  std::vector<std::string> names_;
  std::size_t half_width_;  ///< 0: no intervals
  std::string text_;
};

/// Compares the suite's detector with the detector of a column in one line.
std::string summary_line(const SuiteResult& suite, const SuiteResult& other,
                         const std::vector<Row>& rows, const std::vector<Row>& times,
                         std::size_t column) {
  const auto ahead = [&](const Row& row) { return row.figures[0] - row.figures[column]; };
  const auto count = std::ranges::count_if(rows, [&](const Row& row) { return ahead(row) > 0; });
  const Row& least = *std::ranges::min_element(
      rows, [&](const Row& a, const Row& b) { return ahead(a) < ahead(b); });
  std::string line =
      fmt::format("{} is ahead of {} in {} of {}, least in {} ({:+.3f})", suite.detector,
                  other.detector, count, rows.size(), least.name, ahead(least));
  std::vector<double> ratios;
  for (const Row& row : times) {
    if (row.figures[column] > 0) ratios.push_back(row.figures[0] / row.figures[column]);
  }
  if (const auto ratio = scoring::mean(ratios))
    line += fmt::format("; takes {:.2f} of its time", *ratio);
  return line + '\n';
}

}  // namespace

std::string standing_table(const SuiteResult& suite, std::span<const SuiteResult> others) {
  std::string text = "| detector |", rule = "|---|";
  const std::vector<std::string_view> keys = scoring::keys_in(scoring::Table::detectors);
  for (const std::string_view key : keys) {
    text += fmt::format(" {} |", scoring::metric(key).heading());
    rule += "---|";
  }
  text += '\n' + rule + '\n';
  const auto add = [&](const SuiteResult& by) {
    text += fmt::format("| `{}` |", by.detector);
    for (const std::string_view key : keys) {
      std::vector<double> figures;
      for (const ScenarioResult& scenario : by.scenarios) {
        if (const auto spread = over_seeds(scenario, key)) figures.push_back(spread->mean);
      }
      if (figures.empty()) {
        text += " - |";
        continue;
      }
      const Interval mean = interval_of(figures);
      const int decimals = key == scoring::kF1 ? 3 : scoring::metric(key).scale.decimals;
      text += fmt::format(" {:.{}f}", mean.mean, decimals);
      const bool has_interval = is_of_worlds(by) && !scoring::metric(key).is_time();
      if (has_interval) text += half_text(mean.half.value_or(0), decimals);
      while (text.ends_with(' ')) text.pop_back();
      text += " |";
    }
    text += '\n';
  };
  add(suite);
  for (const SuiteResult& other : others) add(other);
  text += fmt::format("\nMeans over {}; {} and {} over the {} with {}.\n",
                      counted(std::ssize(suite.scenarios), "scenario"),
                      scoring::metric(scoring::kF1).label, scoring::metric("rebel.recall").label,
                      std::ssize(figures_of_group(suite, kAll, scoring::kF1)),
                      scoring::metric(scoring::kF1).label);
  return text;
}

std::string beside_table(const SuiteResult& suite, std::span<const SuiteResult> others) {
  std::vector<Row> rows = rows_of(suite, others, scoring::kF1);
  const std::string& f1 = scoring::metric(scoring::kF1).label;
  if (rows.empty()) return fmt::format("no scenario has an {} by every detector\n", f1);
  const std::vector<Row> times = rows_of(suite, others, kTime);
  std::string lines;
  for (std::size_t i = 0; i < others.size(); ++i) {
    lines += summary_line(suite, others[i], rows, times, i + 1);
  }
  const std::vector<MeanRow> means = means_of(suite, rows);
  const bool of_worlds = is_of_worlds(suite);

  const std::string ahead = fmt::format("{} ahead by", suite.detector);
  std::size_t longest = of_worlds ? ahead.size() : 0;
  for (const std::string_view key : kFalse) {
    if (of_worlds) longest = std::max(longest, scoring::metric(key).heading().size());
  }
  for (const Row& row : rows) longest = std::max(longest, row.name.size());
  for (const MeanRow& row : means) longest = std::max(longest, row.name.size());
  std::vector<std::string> names{suite.detector};
  for (const SuiteResult& other : others) names.push_back(other.detector);

  Columns table(longest, names, of_worlds);
  table.header(f1);
  for (const Row& row : rows) table.row(row);
  for (const MeanRow& row : means) table.row(row, 2);
  if (of_worlds) {
    table.header(ahead, 1);
    for (const MeanRow& row : means_of(suite, leads(rows))) table.row(row, 3, 1);
    // In the groups without F1, where nothing moves, and over all.
    for (const std::string_view key : kFalse) {
      table.header(scoring::metric(key).heading());
      for (const MeanRow& row : means_of(suite, rows_of(suite, others, key), rows)) {
        table.row(row, 1);
      }
    }
    lines = kIntervalLegend + lines;
  }
  return table.text() + lines;
}

}  // namespace lcs::suite
