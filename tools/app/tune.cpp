#include "tools/app/tune.h"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <ctime>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "scenarios/input/message.h"
#include "tools/app/how_made.h"
#include "tools/bench/detector.h"
#include "tools/files/output.h"
#include "tools/suite/suite_result.h"

namespace lcs::app {
namespace {

/// Joins the user's texts into one line; "none" if empty.
std::string line_of(const std::vector<std::string>& texts) {
  std::string line;
  for (const std::string& text : texts) {
    if (!line.empty()) line += ' ';
    line += input::one_line(text);
  }
  return line.empty() ? "none" : line;
}

/// For example "out/train, 60 runs, corridor_1 to yard_10".
std::string about(std::vector<std::string> names, const tune::Trials& trials) {
  for (std::string& name : names)
    name = (suite::folder_of(name) / "").lexically_normal().parent_path();
  std::string first = trials.runs().front().scenario, last = first;
  for (const recording::Recording& run : trials.runs()) {
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
    const auto [key, value] = key_and_value(setting);
    settings.filter.push_back({key, value, {"--set " + setting, 0}});
  }
  return std::get<Parameters>(bench::filter_parameters(settings));
}

/// \throws std::invalid_argument if two paths lead to the same suite.
void require_different(const TuneRequest& request) {
  std::map<fs::path, std::string> known;  // path as given, by canonical folder
  for (const auto* suites : {&request.suites, &request.validate}) {
    for (const std::string& name : *suites) {
      const fs::path folder = fs::weakly_canonical(suite::folder_of(fs::absolute(name)));
      const auto [place, is_new] = known.try_emplace(folder, name);
      if (is_new) continue;
      throw std::invalid_argument(
          fmt::format("{} and {} are one suite; name each suite once", place->second, name));
    }
  }
}

/// All that determines the figures of a search. The suites have been read.
files::Provenance provenance_of(const TuneRequest& request, const tune::Trials& trials,
                                const tune::SearchOptions& search) {
  files::Json facts{{"suites", about(request.suites, trials)},
                    {"settings", request.sets},
                    {"program", program_text()},
                    {"program_sha256", program_sha256()}};
  tune::add_facts(facts, search);
  return files::provenance_of(std::move(facts));
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

}  // namespace

TuneMade tune(const TuneRequest& request, Caller& caller) {
  const auto check = [&] { caller.check(); };
  const Parameters start = start_of(request.sets);
  const std::vector<std::string> keys = request.keys.empty() ? learnt_keys() : request.keys;
  const tune::SearchOptions search_options{tune::axes_of(start, keys), request.evaluations,
                                           request.seed};
  require_different(request);
  const tune::Trials trials(request.suites);
  const files::Provenance provenance = provenance_of(request, trials, search_options);
  if (const std::string what = files::changed_since(provenance); !what.empty()) {
    throw std::runtime_error(what +
                             " it was read; wait until the process that writes to it has ended");
  }
  std::optional<tune::Trials> others;
  if (!request.validate.empty()) others.emplace(request.validate);

  const fs::path out = files::output_path(request.out);
  fs::create_directories(out);
  const files::FolderLock lock(out);
  if (!lock.is_held()) {
    throw std::runtime_error(fmt::format(
        "{} {}; choose another folder with --out", out.string(),
        lock.is_of_another() ? "is in use by another lcs tune"
                             : fmt::format("cannot be locked ({})",
                                           std::generic_category().message(lock.problem()))));
  }
  tune::Evaluations known(out / tune::kEvaluationsFile, provenance, keys);
  files::Output preset_file(out / tune::kPresetFile, files::Overwrite::own);
  files::Output record_file(out / tune::kRecordFile, files::Overwrite::own);
  tune::Found found;
  try {
    const auto progress = caller.progress("tune", request.evaluations, "evaluations");
    found = tune::search(
        start, search_options,
        [&](const Parameters& parameters) { return trials.worth(parameters, check); }, known,
        [&](int done) { progress->show(done); });
  } catch (const Interrupted&) {
    throw Interrupted(
        fmt::format("interrupted; what was tried is in {}, and the same command goes on",
                    (out / tune::kEvaluationsFile).string()));
  }
  std::vector<tune::Stated> stated{
      {about(request.suites, trials), found.worth_before, found.worth_after}};
  if (others) {
    Parameters best = start;
    for (const tune::Setting& setting : found.after) set(best, setting.key, setting.value);
    stated.push_back({about(request.validate, *others), others->worth(start, check),
                      others->worth(best, check)});
  }
  caller.check();
  TuneRequest in_any_place = request;
  in_any_place.out = TuneRequest{}.out;
  const tune::Circumstances circumstances{
      fmt::format("{:%Y-%m-%d}", fmt::gmtime(std::time(nullptr))), program_text(),
      arguments_of(in_any_place)};
  std::string record = tune::record_text(found, stated, circumstances);
  files::write_file(preset_file.staging(),
                    tune::preset_text(with_other_learnt(found, start), circumstances));
  files::write_file(record_file.staging(), record);
  files::commit_all(std::array{&preset_file, &record_file});
  return {std::move(found), std::move(stated), std::move(record), out};
}

}  // namespace lcs::app
