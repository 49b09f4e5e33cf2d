#include "tools/lcs/compare.h"

#include <fmt/format.h>

#include <filesystem>
#include <stdexcept>
#include <string_view>

#include "tools/files/output.h"
#include "tools/input/message.h"
#include "tools/lcs/options.h"
#include "tools/lcs/terminal.h"
#include "tools/suite/comparison.h"
#include "tools/suite/merge_request.h"
#include "tools/suite/pattern.h"
#include "tools/suite/suite_result.h"
#include "tools/suite/verdict.h"

namespace lcs::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp = R"(Examples:
  lcs suite --out out/before
  lcs suite --out out/after --set filter.hypotheses.prior=0.05
  lcs compare out/before out/after
  lcs compare out/before out/after --metric 'rebel\.f1' --all
  lcs compare out/before out/after --markdown out/summary        for a pull request

The verdict is on the means over all scenarios and over each group. A mean has changed when its change is
beyond the least that matters by more than chance explains, given how many means are judged
(tools/suite/README.md). Each is printed with the 95 % interval of its change. Single scenarios are listed
below; one with a single seed has no verdict. Times are never judged.

Exit codes:
  0  no mean regressed
  1  a mean regressed, or a run that had figures before ended with an error
  2  a suite cannot be read, or the two have nothing in common
)";

void print_suite(const char* when, const std::string& path, const suite::SuiteResult& suite) {
  print_out(
      "{} {}: {}\n", when, path,
      input::one_line(fmt::format("{}{}{}", suite.detector, suite.sets.empty() ? "" : " with ",
                                  fmt::join(suite.sets, ", "))));
}

/// \param path a suite.json, or the folder of a suite.
fs::path folder_of(const fs::path& path) {
  return fs::is_directory(path) ? path : path.parent_path();
}

}  // namespace

CLI::App& add_compare_command(CLI::App& app, CompareOptions& options) {
  CLI::App& command = *app.add_subcommand(
      "compare", "Tell what got better and what got worse between two suites, beyond noise");
  command.add_option("BEFORE", options.before, "A suite.json, or the folder of a suite")
      ->required()
      ->type_name("");
  command.add_option("AFTER", options.after, "Another one")->required()->type_name("");
  command
      .add_option("--metric", options.metric,
                  "Only figures with this regular expression in their name")
      ->type_name("REGEX");
  command.add_flag("--all", options.all,
                   "Also what did not change, and figures of which neither way is better");
  command.add_flag_callback(
      "--fail-on-regression", [] {},
      "Exit with 1 where something regressed: this command always does, lcs suite only where it is "
      "asked");
  command
      .add_option("--markdown", options.markdown,
                  "Folder for summary.md, for the discussion of a merge request, and two pictures "
                  "of the event that grew most")
      ->type_name("DIR")
      ->group(kOutputs);
  command
      .add_option("--pictures-at", options.pictures_at,
                  "Address where the pictures will be; beside summary.md if not given")
      ->type_name("URL")
      ->needs("--markdown");
  command.footer(kHelp);
  return command;
}

ExitCode compare(const CompareOptions& options) {
  const suite::Pattern wanted(options.metric, "--metric", "rebel.*f1");
  const suite::SuiteResult before = suite::read_suite(options.before);
  const suite::SuiteResult after = suite::read_suite(options.after);
  const suite::Comparison comparison =
      suite::compare(before, after, [&](std::string_view metric) { return wanted.is_in(metric); });
  if (comparison.scenarios.empty()) {
    throw std::runtime_error(
        fmt::format("{} and {} have no scenario in common; give two suites of the same "
                    "scenarios",
                    options.before, options.after));
  }
  if (!options.markdown.empty()) {
    bench::Output folder(options.markdown,
                         {suite::kSummaryFile, suite::kBeforePicture, suite::kAfterPicture});
    suite::write_merge_request(folder.staging(), {before, folder_of(options.before)},
                               {after, folder_of(options.after)}, comparison, options.pictures_at);
    folder.commit();
  }
  print_suite("before", options.before, before);
  print_suite("after ", options.after, after);
  print_out("{}", input::printable(suite::text_of(comparison, options.all)));
  const suite::Verdict verdict = suite::verdict_of({after, {}}, nullptr, &comparison);
  print_out("{}\n", coloured(verdict.line, verdict.is_good));
  return comparison.has_regressed() ? kRegressed : kFine;
}

}  // namespace lcs::tools
