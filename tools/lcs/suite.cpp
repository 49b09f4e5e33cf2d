/// \file
/// `lcs suite`: runs many scenarios with several seeds each in parallel and prints one table; and
/// `lcs merge`: joins the parts of a suite that `lcs suite --shard` made.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>

#include "scenarios/input/message.h"
#include "scenes/worlds/worlds.h"
#include "tools/app/suite.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"
#include "tools/suite/judgement.h"
#include "tools/suite/summary.h"
#include "tools/suite/tables.h"

namespace lcs::tools {
namespace {

/// The options with which both commands show a suite.
struct SuiteEndOptions {
  bool fail_on_regression = false;  ///< exit with kRegressed if worse than the baseline
  bool worst_first = false;
  bool quiet = false;
  scoring::Format format = {};
};

/// Adds `--fail-on-regression`, `--worst-first`, `--quiet` and `--format`.
void add_suite_end(app::Options& all, SuiteEndOptions& options) {
  all.add("--fail-on-regression", "", &options.fail_on_regression, {.needs = "--baseline"});
  all.add("--worst-first", "", &options.worst_first);
  all.add_quiet(options.quiet);
  add_format(all, options.format);
}

/// Text lines for the user: the number of redraws, and for the split `test` its purpose.
std::string told_of_worlds(const suite::SuiteResult& result) {
  const std::int64_t again = suite::drawn_again(result);
  std::string text =
      fmt::format("{} {} drawn again\n", again, again == 1 ? "world was" : "worlds were");
  if (result.split == "test") {
    text += fmt::format("The split test is {}\n", worlds::split(result.split).purpose);
  }
  return text;
}

/// Prints the changes, worst first.
void print_changes(const suite::SuiteVerdict& verdict, const suite::Comparison& comparison,
                   const std::string& baseline) {
  print_out("Against {}:\n", baseline);
  for (const std::string& what : comparison.incomparable) {
    print_out("not compared: {}\n", input::printable(what));
  }
  print_out("{}", input::printable(suite::means_text(comparison, false)));
  print_out("{}", input::printable(suite::text_of(verdict)));
}

/// In the order of `suite::Outcome`.
constexpr std::array<ExitCode, 3> kExitCodes{kFine, kCriterionFailed, kError};

/// Prints the tables and messages of a suite.
ExitCode show_suite(const app::SuiteMade& made, const app::SuitePlace& place,
                    const SuiteEndOptions& options) {
  const auto& [result, others, comparison, verdict, folder] = made;
  if (options.format != scoring::Format::text && !options.quiet) {
    print_out("{}", suite::suite_table(result, options.worst_first, options.format));
    if (!others.empty()) {
      print_out("\n{}\n{}", suite::standing_table(result, others, options.format),
                suite::beside_table(result, others, options.format));
    }
  } else if (!options.quiet) {
    print_out("{}\n", suite::suite_table(result, options.worst_first));
    if (!others.empty()) print_out("{}\n", suite::beside_table(result, others));
    if (!result.split.empty()) print_out("{}", told_of_worlds(result));
    if (comparison) print_changes(verdict, *comparison, place.baseline);
    // The verdict comes last, where the terminal ends.
    print_out("{}\n{}; results in {}\n", coloured(input::printable(verdict.line), verdict.light),
              suite::run_counts(result), folder.string());
  }
  warn(suite::warnings(result));
  suite::Outcome outcome = suite::outcome_of(result);
  for (const std::string& problem : suite::problems(result)) tell(problem);
  for (const suite::SuiteResult& other : others) {
    outcome = std::max(outcome, suite::outcome_of(other));
    for (const std::string& problem : suite::problems(other)) {
      tell(fmt::format("{}: {}", other.detector, problem));
    }
  }
  const ExitCode by_baseline =
      verdict.finding && options.fail_on_regression ? exit_code_of(*verdict.finding) : kFine;
  if (by_baseline != kFine) tell(fmt::format("against {}: {}", place.baseline, verdict.line));
  return std::max(by_baseline, kExitCodes.at(static_cast<std::size_t>(outcome)));
}

struct SuiteOptions {
  app::SuiteRequest request;
  bool list = false;
  SuiteEndOptions end;
};

ExitCode list_plan(const std::vector<suite::PlannedScenario>& plan) {
  std::size_t longest = 0;
  for (const suite::PlannedScenario& planned : plan)
    longest = std::max(longest, planned.name.size());
  bool is_broken = false;
  for (const suite::PlannedScenario& planned : plan) {
    if (planned.scenario) {
      const int frames = planned.scenario->frames;  // 0: all frames of a recording
      print_out("{:<{}}  {:>4} frames, {} criteria [{}] {}\n", planned.name, longest,
                frames > 0 ? std::to_string(frames) : "all", planned.scenario->criteria.size(),
                fmt::join(planned.scenario->groups, ", "), planned.scenario->purpose);
    } else {
      tell("error: " + planned.error);
      is_broken = true;
    }
  }
  return is_broken ? kError : kFine;
}

ExitCode suite(const SuiteOptions& options) {
  Terminal terminal(options.end.quiet);
  if (options.list) return list_plan(app::plan_suite(options.request, terminal).plan);
  return show_suite(app::suite(options.request, terminal), options.request.place, options.end);
}

app::Options options_of(SuiteOptions& options) {
  app::Options all = app::options_of(options.request);
  add_suite_end(all, options.end);
  all.add("--list", "", &options.list);
  return all;
}

struct MergeOptions {
  app::MergeRequest request;
  SuiteEndOptions end;
};

ExitCode merge(const MergeOptions& options) {
  Terminal terminal(options.end.quiet);
  return show_suite(app::merge(options.request, terminal), options.request.place, options.end);
}

app::Options options_of(MergeOptions& options) {
  app::Options all = app::options_of(options.request);
  add_suite_end(all, options.end);
  return all;
}

}  // namespace

ExitCode exit_code_of(suite::Finding finding) {
  constexpr std::array<ExitCode, 4> kByFinding{kRegressed, kError, kFine, kFine};
  return kByFinding.at(static_cast<std::size_t>(finding));
}

Command suite_command() {
  return command_of("Run many scenarios with several seeds each, in parallel, and sum them up",
                    kSuiteHelp, &suite);
}

Command merge_command() {
  return command_of("Join the parts of a suite that several machines made (lcs suite --shard)",
                    kMergeHelp, &merge);
}

}  // namespace lcs::tools
