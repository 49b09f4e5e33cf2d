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
  scoring::Format format = {};
};

void print_suite(const char* when, const std::string& path, const suite::SuiteResult& suite) {
  print_out(
      "{} {}: {}\n", when, path,
      input::one_line(fmt::format("{}{}{}", suite.detector, suite.sets.empty() ? "" : " with ",
                                  fmt::join(suite.sets, ", "))));
}

ExitCode compare_frames(const CompareOptions& options) {
  if (!options.request.metric.empty() || options.request.allow_missing ||
      options.format != scoring::Format::text) {
    throw std::invalid_argument(
        "--frames compares all frames, and prints no table; leave out --metric, --allow-missing "
        "and --format");
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
  if (options.format != scoring::Format::text) {
    print_out("{}", suite::text_of(comparison, options.all, options.format));
    tell(verdict.line);
    return exit_code_of(*verdict.finding);
  }
  print_suite("before", options.request.before, before);
  print_suite("after ", options.request.after, after);
  print_out("{}", input::printable(suite::text_of(comparison, options.all)));
  print_out("{}\n", coloured(verdict.line, verdict.light));
  return exit_code_of(*verdict.finding);
}

app::Options options_of(CompareOptions& options) {
  app::Options all = app::options_of(options.request);
  all.add("--all", "", &options.all);
  all.add("--frames", "", &options.frames);
  all.add("--fail-on-regression", "", &options.fail_on_regression);
  add_format(all, options.format);
  return all;
}

}  // namespace

Command compare_command() {
  return command_of("List the figures that got better or worse between two suites, beyond noise",
                    kCompareHelp, &compare);
}

}  // namespace lcs::tools
