#include "tools/suite/suite_table.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <optional>
#include <string_view>

#include "tools/suite/interval.h"
#include "tools/suite/summary.h"

namespace lcs::suite {
namespace {

constexpr std::size_t kWidth = 120;

struct Column {
  const char* header;
  std::string_view figure;
  int decimals;
  int width;  ///< of the mean
};
constexpr Column kColumns[] = {
    {"prec", "rebel.precision", 2, 4},
    {"recall", "rebel.recall", 2, 4},
    {"F1", "rebel.f1", 2, 4},
    {"F1 d", "rebel.f1_distinct", 2, 4},
    {"late", "rebel.latency_frames_median", 1, 4},
    {"found", "rebel.object_recall", 2, 4},
    {"false", "rebel.false_objects_per_100_frames", 1, 5},
    {"sq rec", "square.recall_50", 2, 4},
    {"sq prec", "square.precision_50", 2, 4},
    {"size", kSizeShare, 2, 4},
    {"time", "time.filter_over_fast", 1, 4},
};
constexpr const char* kLegend =
    "prec, recall, F1: of rebel corners (F1 d: distinct ones alone); late: frames until an object "
    "is\n"
    "found; found: share of objects; false: false objects per 100 frames; sq: squares at IoU 0.5;\n"
    "size: of all layers, over a store of 5 frames' corners; time: of the filter, over cv::FAST\n";
constexpr const char* kWorldsLegend = "±, of a group: the 95 % interval of its mean over worlds\n";
/// Columns of `half_text` where there are at most two decimals.
constexpr int kSpreadWidth = 4;

class TableText {
 public:
  TableText(std::size_t name_width, bool with_spreads)
      : name_width_(name_width), with_spreads_(with_spreads) {}

  static std::size_t figures_width(bool with_spreads) {
    std::size_t width = 0;
    for (const Column& column : kColumns) {
      width += 1 + cell_width(column, with_spreads);
    }
    return width;
  }

  void header() {
    begin("scenario");
    for (const Column& column : kColumns) {
      // Over the numbers, whose spreads stick out to the right.
      const std::size_t numbers =
          std::max<std::size_t>(std::string_view(column.header).size(), column.width);
      const std::size_t rest = cell_width(column, with_spreads_) - numbers;
      text_ += fmt::format(" {:>{}}{:{}}", column.header, numbers, "", rest);
    }
    end();
  }

  template <class SpreadOf>
  void row(const std::string& name, const SpreadOf& spread_of) {
    begin(name);
    for (const Column& column : kColumns) {
      const std::size_t rest =
          cell_width(column, with_spreads_) - column.width - (with_spreads_ ? kSpreadWidth : 0);
      const std::optional<Spread> spread = spread_of(column.figure);
      text_ += fmt::format(" {:{}}", "", with_spreads_ ? 0 : rest);
      text_ += spread ? fmt::format("{:>{}.{}f}", spread->mean, column.width, column.decimals)
                      : fmt::format("{:>{}}", "-", column.width);
      if (with_spreads_) {
        text_ += spread ? half_text(spread->half, column.decimals) : std::string(kSpreadWidth, ' ');
      }
    }
    end();
  }

  void remark(const std::string& name, const std::string& words) {
    begin(name);
    text_ += " " + words;
    end();
  }
  void line(const std::string& words) { text_ += words; }

  const std::string& text() const { return text_; }

 private:
  static std::size_t cell_width(const Column& column, bool with_spreads) {
    return std::max<std::size_t>(std::string_view(column.header).size(),
                                 column.width + (with_spreads ? kSpreadWidth : 0));
  }
  void begin(const std::string& name) {
    text_ += fmt::format("{:<{}}", name, name_width_);
    if (name.size() > name_width_) text_ += fmt::format("\n{:{}}", "", name_width_);
  }
  void end() {
    while (text_.ends_with(' ')) text_.pop_back();
    text_ += '\n';
  }

  std::size_t name_width_;
  bool with_spreads_;
  std::string text_;
};

/// Errors first, then the least F1, then those that have none.
double badness_key(const ScenarioResult& scenario) {
  if (outcome_of(scenario) == Outcome::error) return -1;
  const std::optional<Spread> f1 = over_seeds(scenario, "rebel.f1");
  return f1 ? f1->mean : 2;
}

std::string marked(const ScenarioResult& scenario) {
  switch (outcome_of(scenario)) {
    case Outcome::passed:
      return "  " + scenario.name;
    case Outcome::failed:
      return "F " + scenario.name;
    case Outcome::error:
      return "E " + scenario.name;
  }
  return scenario.name;
}

std::string group_row_name(const SuiteResult& suite, const std::string& group) {
  return fmt::format("= {} ({})", group, count_in(suite, group));
}

}  // namespace

std::string suite_table(const SuiteResult& suite, bool worst_first) {
  std::vector<const ScenarioResult*> rows;
  for (const ScenarioResult& scenario : suite.scenarios) rows.push_back(&scenario);
  if (worst_first) {
    std::stable_sort(rows.begin(), rows.end(), [](const auto* a, const auto* b) {
      return badness_key(*a) < badness_key(*b);
    });
  }
  const bool of_worlds = is_of_worlds(suite);
  const bool with_spreads = of_worlds || std::any_of(rows.begin(), rows.end(), [](const auto* row) {
                              return row->runs.size() > 1;
                            });
  const std::vector<std::string> groups = groups_of(suite);
  std::size_t longest = std::string_view("scenario").size();
  for (const ScenarioResult* row : rows) longest = std::max(longest, marked(*row).size());
  for (const std::string& group : groups) {
    longest = std::max(longest, group_row_name(suite, group).size());
  }

  TableText table(std::min(longest, kWidth - TableText::figures_width(with_spreads)), with_spreads);
  table.header();
  for (const ScenarioResult* row : rows) {
    const bool has_figures = std::any_of(row->runs.begin(), row->runs.end(),
                                         [](const RunResult& run) { return !run.metrics.empty(); });
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
  table.line(kLegend);
  if (of_worlds) table.line(kWorldsLegend);
  return table.text();
}

std::vector<std::string> problems(const SuiteResult& suite) {
  std::vector<std::string> failures, errors;
  for (const ScenarioResult& scenario : suite.scenarios) {
    std::vector<std::pair<std::string, std::string>> seeds_by_error;  // in order
    for (const RunResult& run : scenario.runs) {
      const std::string seed = std::to_string(run.seed);
      if (run.outcome == Outcome::error) {
        const auto found =
            std::find_if(seeds_by_error.begin(), seeds_by_error.end(),
                         [&](const auto& entry) { return entry.first == run.error; });
        if (found == seeds_by_error.end()) {
          seeds_by_error.emplace_back(run.error, seed);
        } else {
          found->second += ", " + seed;
        }
      }
      for (const CriterionResult& criterion : run.criteria) {
        if (criterion.met) continue;
        failures.push_back(fmt::format("{}: {} seed {}: {}",
                                       criterion.required ? "failed" : "missed (not required)",
                                       scenario.name, seed, criterion.message));
      }
    }
    for (const auto& [error, seeds] : seeds_by_error) {
      // A scenario that could not even be loaded has one run, with no seed of its own.
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
    struct Told {
      bench::Warned first;
      std::string seeds;
    };
    std::vector<Told> told;
    for (const RunResult& run : scenario.runs) {
      for (const bench::Warned& warned : run.warnings) {
        const std::string seed = std::to_string(run.seed);
        const auto found = std::find_if(told.begin(), told.end(), [&](const Told& entry) {
          return entry.first.word == warned.word;
        });
        if (found == told.end()) {
          told.push_back({warned, seed});
        } else {
          found->seeds += ", " + seed;
        }
      }
    }
    for (const Told& entry : told) {
      lines.push_back(fmt::format("{} seed {}: {}", scenario.name, entry.seeds,
                                  bench::lines_of({entry.first}).front()));
    }
  }
  return lines;
}

std::string totals(const SuiteResult& suite) {
  std::map<Outcome, int> counts;
  for (const ScenarioResult& scenario : suite.scenarios) {
    for (const RunResult& run : scenario.runs) ++counts[run.outcome];
  }
  return fmt::format("{} passed, {} failed, {} errors", counts[Outcome::passed],
                     counts[Outcome::failed], counts[Outcome::error]);
}

}  // namespace lcs::suite
