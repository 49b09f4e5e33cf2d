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
};

/// Adds `--fail-on-regression`, `--worst-first` and `--quiet`.
void add_suite_end(app::Options& all, SuiteEndOptions& options) {
  all.add("--fail-on-regression", "", &options.fail_on_regression,
          "Exit with 1 after a regression against the baseline, as lcs compare does",
          {.needs = "--baseline"});
  all.add("--worst-first", "", &options.worst_first, "Sort the table by F1");
  all.add_quiet(options.quiet);
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
  if (!options.quiet) {
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

constexpr const char* kSuiteHelp = R"(Examples:
  lcs suite                                       every short scenario of the project, 3 seeds each
  lcs suite --seeds 1 --worst-first               quicker, and where to look first
  lcs suite --filter crossing --set filter.hypotheses.prior=0.05 --out out/r60
  lcs suite --recorded out/suite --out out/mine --baseline out/suite
                                                  the changed filter on the frames of an earlier suite
  lcs suite --beside klt --beside lcs:lab         F1 of further detectors, and of the filter with the
                                                  paper's preset
  lcs suite --detector mine --detector-command 'python3 mine.py' --beside lcs --beside klt
                                                  a detector of yours beside the filter
  lcs suite --recorded out/suite --detections csv --out out/mine
                                                  its CSV files about an earlier suite's frames
  lcs suite --group sweep --filter distance       a sweep: one run a point and seed
  lcs suite my_scenarios other.yaml               other scenarios, of any group
  lcs suite --group all --list                    the list of all scenarios
  lcs suite --worlds train --count 60             worlds drawn from seeds, one run each
  lcs suite --worlds test --count 60 --beside klt --beside dis --beside lcs:lab
                                                  the filter against other detectors, by family
  lcs suite --worlds train --count 1000 --keep figures    a thousandth of the disk
  lcs suite --worlds train --count 1000 --shard 2/16 --out part2
                                                  a part, on one of 16 machines; lcs merge joins them
  lcs compare out/before out/suite                the differences of two suites, beyond noise

Worlds are kept in out/worlds/ and drawn anew only where the generator changed. A kept world that was edited is
refused. Worlds of the split `test` are for stating figures: nothing is chosen by them (scenes/worlds/README.md).

Seeds are the scenario's own and those that follow. Each run is a process of its own; one that
crashes, or a scenario that is broken, is an error, and the others still run.

The same command continues a suite that was interrupted or killed: finished runs are kept in DIR.unfinished/.

Files written to the folder, all or none:
  run.json      how it was made: command, program, settings, versions, date
  suite.json    every figure and criterion of every run
  report.html   a page for the browser: figures against the baseline, plots, and for each miss and
                false alarm the reasons and a strip of pictures
  worlds.html, worlds/   of worlds: three pictures and the plan of each, with its figures
  junit.xml     a test case a criterion, for continuous integration
  runs/NAME/seed-N/   the files of `lcs run --events`, without a video
  beside/DETECTOR/    with --beside: suite.json and runs/ of that detector, without events and
                      pictures, for lcs compare
  standing.md   with --beside: a row a detector, with its means, in Markdown

Exit codes:
  0  fine
  1  a required criterion is not met; with --fail-on-regression also: regressed from the baseline
  2  a run ended with an error, or nothing could be run; with --fail-on-regression also: not judged, as runs
     of the baseline are missing
  130  interrupted (Ctrl-C): finished runs are kept, an earlier suite is as it was
)";

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
  all.add("--list", "", &options.list, "Only list the runs");
  return all;
}

struct MergeOptions {
  app::MergeRequest request;
  SuiteEndOptions end;
};

constexpr const char* kMergeHelp = R"(Examples:
  lcs suite --worlds train --count 1000 --shard 1/2 --out part1     on one machine
  lcs suite --worlds train --count 1000 --shard 2/2 --out part2     on another
  lcs merge part1 part2 --out out/train

The merged suite has the files of a suite that was made in one go: figures, report, JUnit, tables. The parts
do not change. On one file system their runs are linked, not copied.

Exit codes: as of lcs suite. 2 also if a part is missing or belongs to another suite.
)";

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
