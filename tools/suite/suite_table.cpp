#include "tools/suite/suite_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <string_view>

#include "tools/scoring/metrics.h"
#include "tools/suite/interval.h"
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

}  // namespace lcs::suite
