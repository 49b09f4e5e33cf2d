/// \file
/// `lcs suite`: runs many scenarios with several seeds each in parallel and prints one table.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>

#include "tools/app/suite.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/suite_end.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

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
  const auto progress = suite_progress(options.end.quiet);
  return show_suite(app::suite(options.request, terminal, *progress), options.request.place,
                    options.end);
}

app::Options options_of(SuiteOptions& options) {
  app::Options all = app::options_of(options.request);
  add_suite_end(all, options.end);
  all.add("--list", "", &options.list, "Only list the runs");
  return all;
}

}  // namespace

Command suite_command() {
  return command_of("Run many scenarios with several seeds each, in parallel, and sum them up",
                    kSuiteHelp, &suite);
}

}  // namespace lcs::tools
