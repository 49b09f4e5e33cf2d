#include "tools/lcs/tune.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <optional>

#include "tools/files/output.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/progress.h"
#include "tools/lcs/terminal.h"
#include "tools/lcs/version.h"
#include "tools/tune/record.h"
#include "tools/tune/search.h"
#include "tools/tune/trials.h"

namespace lcs::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp = R"(Examples:
  lcs suite --worlds train --count 200 --out out/train
  lcs suite --worlds validate --count 160 --out out/validate
  lcs tune out/train --validate out/validate              all learnt numbers
  lcs suite my_recordings --out out/recorded; lcs tune out/train out/recorded
  lcs tune out/train --keys hypotheses.prior,hypotheses.newcomer --evaluations 60
  lcs tune out/train --evaluations 1                      what the present ones are worth
  lcs tune out/train --evaluations 1 --set hypotheses.prior=0.05

The frames of the suite's runs are asked of the filter again and again, each time with other numbers,
on all cores. What counts is the mean F1 of rebels over the worlds in which something moves, less a
tenth of the mean number of false objects in a frame, of which no world counts for more than one, and
less a hundredth of the false corners in a frame of recordings in which nothing moves. NLopt's BOBYQA
looks for the most of it, between a quarter of the present values and four times these. Runs of the
split test are refused: nothing is chosen by them.

Each evaluation is kept at once. A search that was interrupted, or is to go on with more evaluations,
goes on where it was by the same command; the same command gives the same numbers.

Files in the folder:
  evaluations.csv    every set that was tried, with its figures
  learnt.h           the best of them, for filter/learnt.h: the preset default takes them from there
  record.md          the suites before and after, the numbers, the command, the program

Exit codes:
  0  fine
  2  error
  130  interrupted (Ctrl-C): the evaluations so far are kept
)";

/// "60 runs, corridor_1 to yard_10".
std::string about(const std::vector<std::string>& names, const tune::Trials& trials) {
  std::string first = trials.runs().front().scenario, last = first;
  for (const bench::Recording& run : trials.runs()) {
    first = std::min(first, run.scenario);
    last = std::max(last, run.scenario);
  }
  return fmt::format("{}, {} runs, {} to {}", fmt::join(names, " "), trials.runs().size(), first,
                     last);
}

std::vector<std::string> learnt_keys() {
  std::vector<std::string> keys;
  for (const ParameterInfo& info : describe(preset("default"))) {
    if (info.learnt) keys.push_back(info.key);
  }
  return keys;
}

/// Learnt parameters that the search left alone keep their values.
tune::Found with_other_learnt(tune::Found found, const Parameters& start) {
  for (const ParameterInfo& info : describe(start)) {
    const auto is_it = [&](const tune::Setting& setting) { return setting.key == info.key; };
    if (info.learnt && std::ranges::none_of(found.after, is_it)) {
      found.after.push_back({info.key, info.value});
    }
  }
  return found;
}

std::string command_of(const TuneOptions& options) {
  std::string command = fmt::format("lcs tune {}", fmt::join(options.suites, " "));
  if (!options.validate.empty()) {
    command += fmt::format(" --validate {}", fmt::join(options.validate, ","));
  }
  if (!options.keys.empty()) command += fmt::format(" --keys {}", fmt::join(options.keys, ","));
  for (const std::string& setting : options.sets) command += fmt::format(" --set {}", setting);
  return command + fmt::format(" --evaluations {} --seed {}", options.evaluations, options.seed);
}

}  // namespace

CLI::App& add_tune_command(CLI::App& app, TuneOptions& options) {
  CLI::App& command = *app.add_subcommand("tune", "Learn the filter's numbers from recorded runs");
  command
      .add_option("--suite,SUITE", options.suites,
                  "Folders of suites of train: worlds, and recordings in which nothing moves")
      ->required()
      ->type_name("");
  command
      .add_option("--validate", options.validate,
                  "Folders of other suites, on which before and after are stated")
      ->delimiter(',')
      ->type_name("SUITE,...");
  command.add_option("--keys", options.keys, "Only these parameters; all learnt ones if not given")
      ->delimiter(',')
      ->type_name("KEY,...");
  add_set_option(command, options.sets,
                 "Set a parameter of the filter before, as hypotheses.prior=0.05");
  add_integer_option(command, "--evaluations", options.evaluations,
                     "Sets of numbers that are tried; 300 if not given", 1, 1000000)
      ->type_name("N");
  add_seed_option(command, options.seed,
                  "1 starts from the present numbers; any other from a point about them");
  add_out_option(command, options.out, "out/tune");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return command;
}

ExitCode tune(const TuneOptions& options) {
  Parameters start = preset("default");
  for (const std::string& setting : options.sets) {
    const auto [key, value] = key_and_value(setting);
    set(start, key, value);
  }
  validate(start);
  const tune::Trials trials(options.suites);
  std::optional<tune::Trials> others;
  if (!options.validate.empty()) others.emplace(options.validate);

  const fs::path out = options.out;
  fs::create_directories(out);
  const tune::SearchOptions search_options{options.keys.empty() ? learnt_keys() : options.keys,
                                           options.evaluations, options.seed};
  const std::string subject = fmt::format("{}, seed {}, {}", about(options.suites, trials),
                                          options.seed, fmt::join(options.sets, " "));
  tune::Found found;
  try {
    Progress progress("tune", options.evaluations, options.quiet, "evaluations");
    found = tune::search(
        start, search_options,
        [&](const Parameters& parameters) { return trials.worth(parameters, check_interrupted); },
        out / tune::kJournalFile, subject, [&](int done) { progress.show(done); });
  } catch (const Interrupted&) {
    tell(fmt::format("lcs: interrupted; what was tried is in {}, and the same command goes on",
                     (out / tune::kJournalFile).string()));
    return kInterrupted;
  }
  std::vector<tune::Stated> stated{
      {about(options.suites, trials), found.worth_before, found.worth_after}};
  if (others) {
    Parameters best = start;
    for (const tune::Setting& setting : found.after) set(best, setting.key, setting.value);
    stated.push_back({about(options.validate, *others), others->worth(start, check_interrupted),
                      others->worth(best, check_interrupted)});
  }
  check_interrupted();
  const tune::Circumstances circumstances{
      fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))), program_text(),
      command_of(options)};
  const std::string record = tune::record_text(found, stated, circumstances);
  bench::Output preset_file(out / tune::kPresetFile, bench::Overwrite::own);
  bench::Output record_file(out / tune::kRecordFile, bench::Overwrite::own);
  bench::write_file(preset_file.staging(),
                    tune::preset_text(with_other_learnt(found, start), circumstances));
  bench::write_file(record_file.staging(), record);
  bench::commit_all(std::array{&preset_file, &record_file});
  if (!options.quiet) print_out("{}\nresults in {}\n", record, out.string());
  return kFine;
}

}  // namespace lcs::tools
