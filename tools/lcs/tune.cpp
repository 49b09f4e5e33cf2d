/// \file
/// `lcs tune`: learns the filter's parameters from recorded runs of the split `train`.

#include "tools/app/tune.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

using TuneOptions = Quietable<app::TuneRequest>;

constexpr const char* kTuneHelp = R"(Examples:
  lcs suite --worlds train --count 200 --out out/train
  lcs suite --worlds validate --count 160 --out out/validate
  lcs tune out/train --validate out/validate              all learnt numbers
  lcs suite my_recordings --out out/recorded; lcs tune out/train out/recorded
  lcs tune out/train --keys hypotheses.prior,hypotheses.newcomer --evaluations 60
  lcs tune out/train --evaluations 1                      the objective of the present numbers
  lcs tune out/train --evaluations 1 --set hypotheses.prior=0.05

The filter runs on the frames of the suites again and again, each time with other numbers, on all cores.
The objective is the mean F1 of rebels over the worlds in which something moves, less a tenth of the mean
number of false objects in a frame (at most one a world), and less a hundredth of the false corners in a
frame of recordings in which nothing moves. NLopt's BOBYQA maximizes it between a quarter of the present
values and four times these. Runs of the split test are refused: nothing is chosen by them. A run
records its world, so it is recognized under any name, with any seed, in another scenario and as a
sequence of lcs generate.

Each evaluation is kept at once, also if the program is killed. The same command continues an interrupted
search, or one with more evaluations, and gives the same numbers. The journal records everything that its
figures depend on: the program, the files of the runs, the suites' names, the settings, the seed, each
number with its start and bounds. If any of these differs, or a row was edited, the command refuses the
journal; remove it then, or name another folder.

Files in the folder:
  evaluations.csv    the journal: every set that was tried, with its figures
  learnt.h           the best of them, for filter/types/learnt.h: the preset default takes them from there
  record.md          the suites before and after, the numbers, the command, the program

Exit codes:
  0  fine
  2  error
  130  interrupted (Ctrl-C): the evaluations so far are kept
)";

ExitCode tune(const TuneOptions& options) {
  Terminal terminal(options.quiet);
  const app::TuneMade made = app::tune(options.request, terminal);
  if (!options.quiet) print_out("{}\nresults in {}\n", made.record, made.folder.string());
  return kFine;
}

}  // namespace

Command tune_command() {
  return command_of("Learn the filter's numbers from recorded runs", kTuneHelp, &tune);
}

}  // namespace lcs::tools
