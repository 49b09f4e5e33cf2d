#include "tools/lcs/tune.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <filesystem>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "tools/app/command_line.h"
#include "tools/app/version.h"
#include "tools/bench/detector.h"
#include "tools/files/output.h"
#include "tools/files/sha256.h"
#include "tools/input/input_file.h"
#include "tools/input/message.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/progress.h"
#include "tools/lcs/terminal.h"
#include "tools/suite/suite_result.h"
#include "tools/tune/journal.h"
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
split test are refused: nothing is chosen by them. A run knows the world that it is of, under any name,
with any seed, in another scenario and as a sequence of lcs generate.

Each evaluation is kept at once, also if the program is killed. A search that was interrupted, or is to
go on with more evaluations, goes on where it was by the same command; the same command gives the same
numbers. The journal states what its figures depend on: the program, the files of the runs, the suites'
names, the settings, the seed, each number with its start and bounds. It is refused where any of these
is another now, and where a row was changed; remove it then, or name another folder.

Files in the folder:
  evaluations.csv    the journal: every set that was tried, with its figures
  learnt.h           the best of them, for filter/learnt.h: the preset default takes them from there
  record.md          the suites before and after, the numbers, the command, the program

Exit codes:
  0  fine
  2  error
  130  interrupted (Ctrl-C): the evaluations so far are kept
)";

/// Joins the user's texts into one line; "none" if empty.
std::string line_of(const std::vector<std::string>& texts) {
  std::string line;
  for (const std::string& text : texts) {
    line += (line.empty() ? "" : " ") + input::one_line(text);
  }
  return line.empty() ? "none" : line;
}

/// For example "out/train, 60 runs, corridor_1 to yard_10".
std::string about(std::vector<std::string> names, const tune::Trials& trials) {
  for (std::string& name : names)
    name = (suite::folder_of(name) / "").lexically_normal().parent_path();
  std::string first = trials.runs().front().scenario, last = first;
  for (const bench::Recording& run : trials.runs()) {
    first = std::min(first, run.scenario);
    last = std::max(last, run.scenario);
  }
  return fmt::format("{}, {} runs, {} to {}", line_of(names), trials.runs().size(),
                     input::one_line(first), input::one_line(last));
}

/// The default parameters with these settings applied.
Parameters start_of(const std::vector<std::string>& sets) {
  scenario::Scenario settings;
  for (const std::string& setting : sets) {
    const auto [key, value] = app::key_and_value(setting);
    settings.filter.push_back({key, value, {"--set " + setting, 0}});
  }
  return std::get<Parameters>(bench::filter_parameters(settings));
}

/// \throws std::invalid_argument if two paths lead to the same suite.
void require_different(const TuneOptions& options) {
  std::map<fs::path, std::string> known;  // path as given, by canonical folder
  for (const auto* suites : {&options.suites, &options.validate}) {
    for (const std::string& name : *suites) {
      const fs::path folder = fs::weakly_canonical(suite::folder_of(fs::absolute(name)));
      const auto [place, is_new] = known.try_emplace(folder, name);
      if (is_new) continue;
      throw std::invalid_argument(
          fmt::format("{} and {} are one suite; name each suite once", place->second, name));
    }
  }
}

/// The facts that determine the figures of a journal.
std::vector<tune::Fact> facts_of(const TuneOptions& options, const tune::Trials& trials,
                                 const tune::SearchOptions& search) {
  constexpr input::FileKind kProgram{input::kGibibyte, "start lcs by its path"};
  std::vector<tune::Fact> facts{
      {"program", fmt::format("{}, SHA-256 {}", app::program_text(),
                              bench::sha256(input::read_file("/proc/self/exe", kProgram)))},
      {"recordings", fmt::format("SHA-256 {}", trials.digest())},
      {"suites", about(options.suites, trials)},
      {"settings", line_of(options.sets)}};
  for (tune::Fact& fact : tune::facts_of(search)) facts.push_back(std::move(fact));
  return facts;
}

std::vector<std::string> learnt_keys() {
  std::vector<std::string> keys;
  for (const ParameterInfo& info : describe(Parameters{})) {
    if (info.learnt) keys.push_back(info.key);
  }
  return keys;
}

/// Adds the learnt parameters that were not searched, with their start values.
tune::Found with_other_learnt(tune::Found found, const Parameters& start) {
  for (const ParameterInfo& info : describe(start)) {
    const auto is_it = [&](const tune::Setting& setting) { return setting.key == info.key; };
    if (info.learnt && std::ranges::none_of(found.after, is_it)) {
      found.after.push_back({info.key, info.value});
    }
  }
  return found;
}

std::vector<std::string> command_of(const TuneOptions& options) {
  std::vector<std::string> command{"tune"};
  const auto add = [&](const std::string& option, const std::string& value) {
    command.insert(command.end(), {option, value});
  };
  command.insert(command.end(), options.suites.begin(), options.suites.end());
  if (!options.validate.empty()) {
    add("--validate", fmt::format("{}", fmt::join(options.validate, ",")));
  }
  if (!options.keys.empty()) add("--keys", fmt::format("{}", fmt::join(options.keys, ",")));
  for (const std::string& setting : options.sets) add("--set", setting);
  add("--evaluations", std::to_string(options.evaluations));
  add("--seed", std::to_string(options.seed));
  return command;
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
  const Parameters start = start_of(options.sets);
  const std::vector<std::string> keys = options.keys.empty() ? learnt_keys() : options.keys;
  const tune::SearchOptions search_options{tune::axes_of(start, keys), options.evaluations,
                                           options.seed};
  require_different(options);
  const tune::Trials trials(options.suites);
  std::optional<tune::Trials> others;
  if (!options.validate.empty()) others.emplace(options.validate);

  const fs::path out = bench::output_path(options.out);
  fs::create_directories(out);
  const bench::FolderLock lock(out);
  if (!lock.is_held()) {
    throw std::runtime_error(
        fmt::format("{} {}; choose another folder with --out", out.string(),
                    lock.is_of_another() ? "is in use by another lcs tune" : "cannot be locked"));
  }
  tune::Journal journal(out / tune::kJournalFile, facts_of(options, trials, search_options), keys);
  bench::Output preset_file(out / tune::kPresetFile, bench::Overwrite::own);
  bench::Output record_file(out / tune::kRecordFile, bench::Overwrite::own);
  tune::Found found;
  try {
    Progress progress("tune", options.evaluations, options.quiet, "evaluations");
    found = tune::search(
        start, search_options,
        [&](const Parameters& parameters) { return trials.worth(parameters, check_interrupted); },
        journal, [&](int done) { progress.show(done); });
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
      fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))), app::program_text(),
      command_of(options)};
  const std::string record = tune::record_text(found, stated, circumstances);
  bench::write_file(preset_file.staging(),
                    tune::preset_text(with_other_learnt(found, start), circumstances));
  bench::write_file(record_file.staging(), record);
  bench::commit_all(std::array{&preset_file, &record_file});
  if (!options.quiet) print_out("{}\nresults in {}\n", record, out.string());
  return kFine;
}

}  // namespace lcs::tools
