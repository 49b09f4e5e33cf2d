#include "tools/suite/tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <optional>

#include "tools/scoring/metrics.h"
#include "tools/scoring/statistics.h"
#include "tools/scoring/table.h"
#include "tools/suite/interval.h"
#include "tools/suite/judgement.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

using scoring::FigureTable;
using scoring::Format;

constexpr const char* kWorldsLegend = "±, of a group: the 95 % interval of its mean over worlds\n";

scoring::Cell cell_of(const Interval& mean, bool with_half, int decimals, bool is_signed = false) {
  return scoring::TableFigure{mean.mean, with_half ? mean.half : std::nullopt, decimals, is_signed};
}

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

/// Compares the suite's detector with the detector of a column in one line.
std::string summary_line(const SuiteResult& suite, const SuiteResult& other,
                         const std::vector<Row>& rows, const std::vector<Row>& times,
                         std::size_t column) {
  const auto ahead = [&](const Row& row) { return row.figures[0] - row.figures[column]; };
  const auto count = std::ranges::count_if(rows, [&](const Row& row) { return ahead(row) > 0; });
  const Row& least = *std::ranges::min_element(rows, {}, ahead);
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

std::string suite_table(const SuiteResult& suite, bool worst_first, Format format) {
  std::vector<const ScenarioResult*> rows;
  for (const ScenarioResult& scenario : suite.scenarios) rows.push_back(&scenario);
  if (worst_first) {
    std::ranges::stable_sort(rows, {}, [](const auto* row) { return badness_key(*row); });
  }
  const bool of_worlds = is_of_worlds(suite), is_text = format == Format::text;
  std::vector<std::string> groups = groups_of(suite);
  if (rows.size() == 1) std::erase(groups, kAll);  // the row of the scenario itself

  const std::vector<std::string_view> keys = scoring::keys_in(scoring::Table::suite);
  FigureTable table{{{"scenario", "scenario"}}};
  for (const std::string_view key : keys) {
    const scoring::Metric& metric = scoring::metric(key);
    table.columns.push_back({metric.key, is_text ? metric.label : metric.heading()});
  }
  if (!is_text) table.columns.push_back({"outcome", "outcome"});  // text has a mark before the name
  const auto add = [&](const std::string& name, const char* outcome, const auto& cell_in) {
    std::vector<scoring::Cell>& cells = table.rows.emplace_back();
    cells.emplace_back(name);
    for (const std::string_view key : keys) {
      cells.push_back(cell_in(key, scoring::metric(key).scale.decimals));
    }
    if (!is_text) cells.emplace_back(outcome);
  };
  for (const ScenarioResult* row : rows) {
    add(is_text ? marked(*row) : row->name, word_of(outcome_of(*row)),
        [&](std::string_view key, int decimals) -> scoring::Cell {
          const std::optional<Spread> spread = over_seeds(*row, key);
          if (!spread) return {};
          return cell_of({spread->mean, spread->half, 0, 0}, spread->count > 1, decimals);
        });
  }
  for (const std::string& group : groups) {
    add("= " + counted_group(suite, group), "",
        [&](std::string_view key, int decimals) -> scoring::Cell {
          const std::vector<double> figures = figures_of_group(suite, group, key);
          if (figures.empty()) return {};
          return cell_of(interval_of(figures), of_worlds, decimals);
        });
  }
  std::string text = table_text(table, format);
  if (!is_text) return text;
  for (const std::string_view key : keys) {
    const scoring::Metric& metric = scoring::metric(key);
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

std::string standing_table(const SuiteResult& suite, std::span<const SuiteResult> others,
                           Format format) {
  const std::vector<std::string_view> keys = scoring::keys_in(scoring::Table::detectors);
  FigureTable table{{{"detector", "detector"}}};
  for (const std::string_view key : keys) {
    table.columns.push_back({std::string(key), scoring::metric(key).heading()});
  }
  const auto add = [&](const SuiteResult& by) {
    std::vector<scoring::Cell>& cells = table.rows.emplace_back();
    cells.emplace_back(format == Format::markdown ? '`' + by.detector + '`' : by.detector);
    for (const std::string_view key : keys) {
      const std::vector<double> figures = figures_of_group(by, kAll, key);
      if (figures.empty()) {
        cells.emplace_back();
        continue;
      }
      const scoring::Metric& metric = scoring::metric(key);
      cells.push_back(cell_of(interval_of(figures), is_of_worlds(by) && !metric.is_time(),
                              key == scoring::kF1 ? 3 : metric.scale.decimals));
    }
  };
  add(suite);
  for (const SuiteResult& other : others) add(other);
  return table_text(table, format);
}

std::string standing_page(const SuiteResult& suite, std::span<const SuiteResult> others) {
  return fmt::format("{}\nMeans over {}; {} and {} over the {} with {}.\n",
                     standing_table(suite, others, Format::markdown),
                     counted(std::ssize(suite.scenarios), "scenario"),
                     scoring::metric(scoring::kF1).label, scoring::metric("rebel.recall").label,
                     std::ssize(figures_of_group(suite, kAll, scoring::kF1)),
                     scoring::metric(scoring::kF1).label);
}

std::string beside_table(const SuiteResult& suite, std::span<const SuiteResult> others,
                         Format format) {
  const std::vector<Row> rows = rows_of(suite, others, scoring::kF1);
  const std::string& f1 = scoring::metric(scoring::kF1).label;
  if (rows.empty()) {
    if (format != Format::text) return "";
    return fmt::format("no scenario has an {} by every detector\n", f1);
  }
  const bool of_worlds = is_of_worlds(suite);
  const auto table_of = [&](std::string_view key, const std::string& heading, bool with_own) {
    FigureTable table{{{std::string(key), heading}}};
    if (with_own) table.columns.push_back({suite.detector, suite.detector});
    for (const SuiteResult& other : others) {
      table.columns.push_back({other.detector, other.detector});
    }
    return table;
  };
  const auto add = [&](FigureTable& table, const std::vector<MeanRow>& means, int decimals,
                       bool is_lead) {
    for (const MeanRow& mean : means) {
      std::vector<scoring::Cell>& cells = table.rows.emplace_back();
      cells.emplace_back(mean.name);
      for (std::size_t d = is_lead ? 1 : 0; d < mean.means.size(); ++d) {
        cells.push_back(cell_of(mean.means[d], of_worlds, decimals, is_lead));
      }
    }
  };

  FigureTable figures = table_of(scoring::kF1, f1, true);
  for (const Row& row : rows) {
    std::vector<scoring::Cell>& cells = figures.rows.emplace_back();
    cells.emplace_back(row.name);
    for (const double figure : row.figures) cells.emplace_back(scoring::TableFigure{figure});
  }
  add(figures, means_of(suite, rows), 2, false);
  std::vector<FigureTable> tables{figures};
  if (of_worlds) {
    tables.push_back(table_of("ahead", fmt::format("{} ahead by", suite.detector), false));
    add(tables.back(), means_of(suite, leads(rows)), 3, true);
    // In the groups without F1, where nothing moves, and over all.
    for (const std::string_view key : kFalse) {
      tables.push_back(table_of(key, scoring::metric(key).heading(), true));
      add(tables.back(), means_of(suite, rows_of(suite, others, key), rows), 1, false);
    }
  }
  std::string text;
  for (const FigureTable& table : tables) {
    if (!text.empty() && format != Format::text) text += '\n';
    text += table_text(table, format);
  }
  if (format != Format::text) return text;
  if (of_worlds) text += kIntervalLegend;
  const std::vector<Row> times = rows_of(suite, others, kTime);
  for (std::size_t i = 0; i < others.size(); ++i) {
    text += summary_line(suite, others[i], rows, times, i + 1);
  }
  return text;
}

}  // namespace lcs::suite
