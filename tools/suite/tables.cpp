#include "tools/suite/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>
#include <string_view>
#include <utility>

#include "tools/scoring/metrics.h"
#include "tools/scoring/statistics.h"
#include "tools/suite/interval.h"
#include "tools/suite/judgement.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

constexpr std::size_t kWidth = 120;

struct Column {
  const scoring::Metric& metric;
  int width = 4;  ///< of the mean, in characters
};
const std::vector<Column>& columns() {
  static const std::vector<Column> all = [] {
    std::vector<Column> made;
    for (const std::string_view key : scoring::keys_in(scoring::Table::suite)) {
      made.push_back({scoring::metric(key)});
      if (key == "rebel.false_objects_per_100_frames") made.back().width = 5;
    }
    return made;
  }();
  return all;
}
constexpr const char* kWorldsLegend = "±, of a group: the 95 % interval of its mean over worlds\n";
/// Width of `half_text` for at most two decimals, in characters.
constexpr int kSpreadWidth = 4;

class TableText {
 public:
  /// \param longest width of the longest name.
  TableText(std::size_t longest, bool with_spreads) : with_spreads_(with_spreads) {
    std::size_t figures_width = 0;
    for (const Column& column : columns()) figures_width += 1 + cell_width(column);
    name_width_ = std::min(longest, kWidth - figures_width);
  }

  void header() {
    begin("scenario");
    for (const Column& column : columns()) {
      // Aligns the label with the numbers; the spreads extend to the right.
      const std::size_t numbers = std::max<std::size_t>(column.metric.label.size(), column.width);
      const std::size_t rest = cell_width(column) - numbers;
      text_ += fmt::format(" {:>{}}{:{}}", column.metric.label, numbers, "", rest);
    }
    end();
  }

  template <class SpreadOf>
  void row(const std::string& name, const SpreadOf& spread_of) {
    begin(name);
    for (const Column& column : columns()) {
      const std::size_t rest =
          cell_width(column) - column.width - (with_spreads_ ? kSpreadWidth : 0);
      const std::optional<Spread> spread = spread_of(column.metric.key);
      text_ += fmt::format(" {:{}}", "", rest);
      text_ += spread ? fmt::format("{:>{}.{}f}", spread->mean, column.width,
                                    column.metric.scale.decimals)
                      : fmt::format("{:>{}}", "-", column.width);
      if (with_spreads_) {
        text_ += spread ? half_text(spread->half, column.metric.scale.decimals)
                        : std::string(kSpreadWidth, ' ');
      }
    }
    end();
  }

  void remark(const std::string& name, const std::string& words) {
    begin(name);
    text_ += " " + words;
    end();
  }
  /// The table so far.
  std::string text() const { return text_; }

 private:
  std::size_t cell_width(const Column& column) const {
    return std::max<std::size_t>(column.metric.label.size(),
                                 column.width + (with_spreads_ ? kSpreadWidth : 0));
  }
  void begin(const std::string& name) {
    text_ += fmt::format("{:<{}}", name, name_width_);
    if (name.size() > name_width_) text_ += fmt::format("\n{:{}}", "", name_width_);
  }
  void end() {
    while (text_.ends_with(' ')) text_.pop_back();
    text_ += '\n';
  }

  std::size_t name_width_ = 0;
  bool with_spreads_;
  std::string text_;
};

/// Sort key: errors first, then by F1 upwards, then scenarios without F1.
double badness_key(const ScenarioResult& scenario) {
  if (outcome_of(scenario) == Outcome::error) return -1;
  const std::optional<Spread> f1 = over_seeds(scenario, scoring::kF1);
  return f1 ? f1->mean : 2;
}

std::string marked(const ScenarioResult& scenario) {
  constexpr const char* kMarks[] = {"  ", "F ", "E "};  // in the order of `Outcome`
  return kMarks[static_cast<int>(outcome_of(scenario))] + scenario.name;
}

/// A message shared by several seeds.
struct Repeated {
  std::string key;
  std::string text;   ///< the first seed's message
  std::string seeds;  ///< "1, 3"
};

void add(std::vector<Repeated>& messages, const std::string& key, const std::string& text,
         std::uint64_t seed) {
  const auto found = std::ranges::find(messages, key, &Repeated::key);
  if (found == messages.end()) {
    messages.push_back({key, text, std::to_string(seed)});
  } else {
    found->seeds += fmt::format(", {}", seed);
  }
}

std::string group_row_name(const SuiteResult& suite, const std::string& group) {
  return "= " + counted_group(suite, group);
}

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

std::string suite_table(const SuiteResult& suite, bool worst_first) {
  std::vector<const ScenarioResult*> rows;
  for (const ScenarioResult& scenario : suite.scenarios) rows.push_back(&scenario);
  if (worst_first) {
    std::ranges::stable_sort(
        rows, [](const auto* a, const auto* b) { return badness_key(*a) < badness_key(*b); });
  }
  const bool of_worlds = is_of_worlds(suite);
  const bool with_spreads =
      of_worlds || std::ranges::any_of(rows, [](const auto* row) { return row->runs.size() > 1; });
  std::vector<std::string> groups = groups_of(suite);
  if (rows.size() == 1) std::erase(groups, kAll);  // the row of the scenario itself
  std::size_t longest = std::string_view("scenario").size();
  for (const ScenarioResult* row : rows) longest = std::max(longest, marked(*row).size());
  for (const std::string& group : groups) {
    longest = std::max(longest, group_row_name(suite, group).size());
  }

  TableText table(longest, with_spreads);
  table.header();
  for (const ScenarioResult* row : rows) {
    const bool has_figures =
        std::ranges::any_of(row->runs, [](const RunResult& run) { return !run.metrics.empty(); });
    if (has_figures) {
      table.row(marked(*row), [&](std::string_view name) { return over_seeds(*row, name); });
    } else {
      table.remark(marked(*row), "no figures");
    }
  }
  for (const std::string& group : groups) {
    table.row(group_row_name(suite, group), [&](std::string_view name) -> std::optional<Spread> {
      const std::vector<double> figures = figures_of_group(suite, group, name);
      if (figures.empty()) return std::nullopt;
      const Interval mean = interval_of(figures);
      return Spread{mean.mean, of_worlds ? mean.half.value_or(0) : 0, 1};
    });
  }
  std::string text = table.text();
  for (const auto& [metric, width] : columns()) {
    text += fmt::format("  {:<10} {}: {}\n", metric.label, metric.key, metric.first_sentence());
  }
  if (of_worlds) text += kWorldsLegend;
  return text;
}

std::vector<std::string> problems(const SuiteResult& suite) {
  std::vector<std::string> failures, errors;
  for (const ScenarioResult& scenario : suite.scenarios) {
    std::vector<Repeated> run_errors;
    for (const RunResult& run : scenario.runs) {
      if (run.outcome == Outcome::error) add(run_errors, run.error, run.error, run.seed);
      for (const scoring::JudgedCriterion& criterion : run.criteria) {
        const bool is_told = criterion.over != "seed" && &run != &scenario.runs.front();
        if (criterion.met || is_told) continue;
        const std::string of = criterion.over == "seed" ? fmt::format(" seed {}", run.seed) : "";
        failures.push_back(fmt::format("{}: {}{}: {}",
                                       criterion.required ? "failed" : "missed (not required)",
                                       scenario.name, of, criterion.message));
      }
    }
    for (const auto& [key, error, seeds] : run_errors) {
      // A scenario that failed to load has a single run with the placeholder seed 0.
      const std::string which = seeds == "0" ? "" : " seed " + seeds;
      errors.push_back(fmt::format("error: {}{}: {}", scenario.name, which, error));
    }
  }
  failures.insert(failures.end(), errors.begin(), errors.end());
  return failures;
}

std::vector<std::string> warnings(const SuiteResult& suite) {
  std::vector<std::string> lines;
  for (const ScenarioResult& scenario : suite.scenarios) {
    std::vector<Repeated> told;
    for (const RunResult& run : scenario.runs) {
      for (const recording::Warned& warned : run.warnings) {
        add(told, warned.word, recording::lines_of({warned}).front(), run.seed);
      }
    }
    for (const auto& [word, text, seeds] : told) {
      lines.push_back(fmt::format("{} seed {}: {}", scenario.name, seeds, text));
    }
  }
  return lines;
}

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
      const std::vector<double> figures = figures_of_group(by, kAll, key);
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
