/// \file
/// `lcs compare`: the differences between two suites beyond the noise of their seeds.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cstdint>
#include <stdexcept>

#include "scenarios/input/message.h"
#include "tools/app/compare.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"
#include "tools/suite/judgement.h"

namespace lcs::tools {
namespace {

struct CompareOptions {
  app::CompareRequest request;
  bool all = false;
  bool frames = false;
  bool fail_on_regression = true;  ///< always
};

constexpr const char* kCompareHelp = R"(Examples:
  lcs suite --out out/before
  lcs suite --out out/after --set filter.hypotheses.prior=0.05
  lcs compare out/before out/after
  lcs compare out/before out/after --metric 'rebel\.f1' --all
  lcs compare out/before out/after --markdown out/summary        for a pull request
  lcs compare out/before out/after --frames      after a change that should change nothing: the first frame of
                                                 each run that differs, and its corners; also of two runs

The verdict is one of four (tools/suite/README.md). It rests on the means of four main figures over all
scenarios: F1, false corners a frame, false objects and boxes of movers; with --metric on the figures that it names.
  regressed            a main mean got worse by more than matters and than chance explains, or a run that had
                       figures before ended with an error
  not judged           runs of BEFORE are missing in AFTER or have other frames, or no main figure is in both
  no regression found  but a loss is not excluded, whose size is printed; or another mean or a scenario
                       regressed, or a criterion failed
  equal                no main figure has lost more than the printed amount
Other means and single scenarios are a list below; one with a single seed has no verdict. Times are never judged.

Exit codes:
  0  equal, or no regression found; with --frames: all frames are equal
  1  regressed; with --frames: a frame differs
  2  not judged, a suite cannot be read, or the two have nothing in common; with --frames: runs of only one side
)";

void print_suite(const char* when, const std::string& path, const suite::SuiteResult& suite) {
  print_out(
      "{} {}: {}\n", when, path,
      input::one_line(fmt::format("{}{}{}", suite.detector, suite.sets.empty() ? "" : " with ",
                                  fmt::join(suite.sets, ", "))));
}

ExitCode compare_frames(const CompareOptions& options) {
  if (!options.request.metric.empty() || options.request.allow_missing) {
    throw std::invalid_argument(
        "--frames compares all frames; leave out --metric and --allow-missing");
  }
  const app::ComparedFrames compared = app::compare_frames(options.request);
  for (const app::RunFrames& run : compared.runs) {
    if (run.difference.first) {
      print_out("{}", app::first_frame_text(run, options.all ? SIZE_MAX : app::kMostCorners));
    }
  }
  for (const std::string& name : compared.missing) print_out("not compared: {}\n", name);
  const bool is_equal = !compared.is_different && compared.missing.empty();
  print_out("{}\n", coloured(compared.line, is_equal ? suite::Light::green : suite::Light::red));
  return compared.is_different ? kRegressed : compared.missing.empty() ? kFine : kError;
}

ExitCode compare(const CompareOptions& options) {
  if (options.frames) return compare_frames(options);
  const auto [before, after, comparison, verdict, warnings] = app::compare(options.request);
  warn(warnings);
  print_suite("before", options.request.before, before);
  print_suite("after ", options.request.after, after);
  print_out("{}", input::printable(suite::text_of(comparison, options.all)));
  print_out("{}\n", coloured(verdict.line, verdict.light));
  return exit_code_of(*verdict.finding);
}

app::Options options_of(CompareOptions& options) {
  app::Options all = app::options_of(options.request);
  all.add("--all", "", &options.all,
          "Also unchanged figures, and figures without a better direction; with --frames all "
          "corners");
  all.add("--frames", "", &options.frames,
          "Instead of figures, name the first frame of each run that differs, with its corners");
  all.add(
      "--fail-on-regression", "", &options.fail_on_regression,
      "Exit with 1 after a regression: this command always does, lcs suite only if it is asked");
  return all;
}

}  // namespace

Command compare_command() {
  return command_of("List the figures that got better or worse between two suites, beyond noise",
                    kCompareHelp, &compare);
}

}  // namespace lcs::tools
