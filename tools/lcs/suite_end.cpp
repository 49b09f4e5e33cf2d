#include "tools/lcs/suite_end.h"

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>

#include "tools/files/output_file.h"
#include "tools/input/message.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/suite_worlds.h"
#include "tools/lcs/terminal.h"
#include "tools/report/report_page.h"
#include "tools/report/worlds_page.h"
#include "tools/suite/beside_table.h"
#include "tools/suite/comparison.h"
#include "tools/suite/judgement.h"
#include "tools/suite/junit.h"
#include "tools/suite/suite_table.h"
#include "tools/suite/summary.h"
#include "tools/suite/verdict.h"

namespace lcs::tools {
namespace {

namespace fs = std::filesystem;

/// Prints the changes, worst first.
void print_changes(const suite::Verdict& verdict, const suite::Comparison& comparison,
                   const std::string& baseline) {
  print_out("Against {}:\n", baseline);
  for (const std::string& what : comparison.incomparable) {
    print_out("not compared: {}\n", input::printable(what));
  }
  print_out("{}", input::printable(suite::means_text(comparison, false)));
  print_out("{}", input::printable(suite::text_of(verdict)));
}

ExitCode exit_code(suite::Outcome outcome) {
  switch (outcome) {
    case suite::Outcome::passed:
      return kFine;
    case suite::Outcome::failed:
      return kCriterionFailed;
    case suite::Outcome::error:
      return kError;
  }
  return kError;
}

}  // namespace

void add_suite_end_options(CLI::App& command, SuiteEndOptions& options) {
  add_out_option(command, options.out, SuiteEndOptions::kPlace);
  CLI::Option* baseline =
      command
          .add_option("--baseline", options.baseline,
                      "An earlier suite.json or its folder, to show changes against")
          ->type_name("FILE");
  command
      .add_flag("--fail-on-regression", options.fail_on_regression,
                "Exit with 1 where something regressed against the baseline, as lcs compare does")
      ->needs(baseline);
  command.add_flag("--worst-first", options.worst_first, "Sort the table by F1");
  add_quiet_option(command, options.quiet);
}

std::optional<suite::SuiteResult> baseline_of(const SuiteEndOptions& options) {
  if (options.baseline.empty()) return std::nullopt;
  return suite::read_suite(options.baseline);
}

fs::path part_of(const std::string& detector, const std::string& own) {
  return detector == own ? fs::path() : fs::path("beside") / detector;
}

ExitCode finish_suite(bench::Output& folder, const SuiteEndOptions& options,
                      const suite::SuiteResult& result,
                      const std::vector<suite::SuiteResult>& others,
                      const std::optional<suite::SuiteResult>& baseline) {
  for (const suite::SuiteResult& other : others) {
    suite::write_suite(
        folder.staging() / part_of(other.detector, result.detector) / suite::kSuiteFile, other);
  }
  suite::write_suite(folder.staging() / suite::kSuiteFile, result);
  suite::write_junit(folder.staging() / suite::kJunitFile, result, others);
  if (!others.empty()) {
    bench::write_file(folder.staging() / suite::kStandingFile,
                      suite::standing_table(result, others));
  }
  const suite::SuiteInFolder made{result, folder.staging()};
  std::optional<suite::SuiteInFolder> before;
  std::optional<suite::Comparison> comparison;
  if (baseline) {
    before.emplace(suite::SuiteInFolder{*baseline, suite::folder_of(options.baseline)});
    comparison = suite::compare(*baseline, result, [](std::string_view) { return true; });
  }
  const suite::SuiteInFolder* beside = before ? &*before : nullptr;
  const suite::Verdict verdict =
      suite::verdict_of(made, beside, comparison ? &*comparison : nullptr, others);
  std::optional<report::Against> against;
  if (before) against.emplace(report::Against{*before, *comparison});
  report::write_report(folder.staging() / report::kReportFile, made, verdict,
                       against ? &*against : nullptr);
  if (!result.split.empty()) {
    const worlds::Split& split = worlds::split(result.split);
    report::write_worlds_page(folder.staging(),
                              fmt::format("The split {} is {}.", split.name, split.purpose), result,
                              others);
  }
  check_interrupted();
  folder.commit();

  if (!options.quiet) {
    print_out("{}\n", suite::suite_table(result, options.worst_first));
    if (!others.empty()) print_out("{}\n", suite::beside_table(result, others));
    if (!result.split.empty()) print_out("{}", told_of_worlds(result));
    if (comparison) print_changes(verdict, *comparison, options.baseline);
    // The verdict comes last, where the terminal ends.
    print_out("{}\n{}; results in {}\n", coloured(input::printable(verdict.line), verdict.is_good),
              suite::run_counts(result), folder.target().string());
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
  const bool is_worse = comparison && comparison->has_regressed();
  if (!is_worse || !options.fail_on_regression) return exit_code(outcome);
  tell(fmt::format("against {}: {}", options.baseline, verdict.line));
  return outcome == suite::Outcome::error ? kError : kRegressed;
}

}  // namespace lcs::tools
