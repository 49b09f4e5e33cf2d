#include "tools/lcs/suite_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>

#include "scenarios/input/message.h"
#include "scenes/worlds/worlds.h"
#include "tools/lcs/terminal.h"
#include "tools/suite/judgement.h"
#include "tools/suite/summary.h"
#include "tools/suite/tables.h"

namespace lcs::tools {
namespace {

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

}  // namespace

void add_suite_end(app::Options& all, SuiteEndOptions& options) {
  all.add("--fail-on-regression", "", &options.fail_on_regression,
          "Exit with 1 after a regression against the baseline, as lcs compare does",
          {.needs = "--baseline"});
  all.add("--worst-first", "", &options.worst_first, "Sort the table by F1");
  all.add_quiet(options.quiet);
}

ExitCode exit_code_of(suite::Finding finding) {
  constexpr std::array<ExitCode, 4> kByFinding{kRegressed, kError, kFine, kFine};
  return kByFinding.at(static_cast<std::size_t>(finding));
}

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

}  // namespace lcs::tools
