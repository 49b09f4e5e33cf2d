// The end of a suite, and the joining of the parts of one.
#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "scenarios/input/message.h"
#include "scenes/worlds/worlds.h"
#include "tools/app/how_made.h"
#include "tools/app/suite.h"
#include "tools/files/output.h"
#include "tools/files/output_file.h"
#include "tools/files/written.h"
#include "tools/report/report_page.h"
#include "tools/suite/parts.h"
#include "tools/suite/suite_run.h"
#include "tools/suite/tables.h"

namespace lcs::app {
namespace {

/// A part, which may come from another machine and from somebody else.
struct Part {
  fs::path folder;
  files::WrittenFiles files;  ///< all of them as they were written
  files::Provenance provenance;
};

/// \throws std::runtime_error if a file of the part is not as lcs has written it.
Part read_part(const std::string& named) {
  Part part{.folder = suite::folder_of(named), .files = {}, .provenance = {}};
  if (const std::string what = files::first_difference(part.folder); !what.empty()) {
    throw std::runtime_error(
        fmt::format("{}: {}; make that part again", part.folder.string(), what));
  }
  part.files = files::read_record(part.folder / files::kRecordName);
  part.provenance = files::read_how_made(part.folder);
  return part;
}

/// \throws std::runtime_error for parts of which the provenances differ.
files::Provenance joined(const std::vector<Part>& parts, const suite::SuiteResult& whole) {
  const Part& first = parts.front();
  files::Provenance provenance{.facts = first.provenance.facts, .read = {}};
  for (const Part& part : parts) {
    const std::string what = files::difference(first.provenance, part.provenance, kFactsOfParts);
    if (!what.empty()) {
      throw std::runtime_error(fmt::format("{} and {} are no parts of one suite: {}",
                                           first.folder.string(), part.folder.string(), what));
    }
    provenance.add_read(part.provenance, part.folder.string());
  }
  suite::SuiteRuns runs;
  for (const suite::ScenarioResult& scenario : whole.scenarios) {
    std::vector<std::uint64_t>& seeds = runs.emplace_back(scenario.name, 0).second;
    for (const suite::RunResult& run : scenario.runs) seeds.push_back(run.seed);
  }
  add_part(provenance.facts, "", runs);
  return provenance;
}

/// Takes the files of the runs, of all detectors, and the pictures of worlds. The report and so on
/// are made anew.
void take_files(const Part& part, const fs::path& to, Caller& caller) {
  const files::ResultNames names = suite::suite_files();
  for (const auto& [name, digest] : part.files) {
    caller.check();
    const fs::path file = name;
    if (!files::is_inner(file) || !files::is_name_of(file, names)) {
      throw std::runtime_error(fmt::format("{}: {} is no file of a suite; make that part again",
                                           part.folder.string(), input::one_line(name)));
    }
    const fs::path top = *file.begin();
    const bool is_of_detector = top == "beside" && file.filename() != suite::kSuiteFile;
    if (top != "runs" && top != report::kSheetsFolder && !is_of_detector) continue;
    fs::create_directories((to / file).parent_path());
    files::link_or_copy(part.folder / file, to / file);
  }
}

/// The suites of one detector. \param within its folder in each part.
suite::SuiteResult merged(const std::vector<Part>& parts, const fs::path& within) {
  std::vector<suite::SuiteResult> suites;
  suites.reserve(parts.size());  // `in_folders` refers to them
  std::vector<suite::SuiteInFolder> in_folders;
  for (const Part& part : parts) {
    const fs::path place = within.empty() ? part.folder : part.folder / within;
    suites.push_back(suite::read_suite(place));
    in_folders.push_back({suites.back(), place});
  }
  return suite::merge(in_folders);
}

}  // namespace

std::optional<suite::SuiteResult> baseline_of(const SuitePlace& place) {
  if (place.baseline.empty()) return std::nullopt;
  return suite::read_suite(place.baseline);
}

std::vector<std::string> other_inputs(const fs::path& before, const fs::path& after) {
  for (const fs::path& suite : {before, after}) {
    if (!fs::exists(suite / files::kHowMadeFile)) return {};
  }
  const auto read_by = [](const fs::path& suite) {
    return files::Provenance{.facts = {}, .read = files::read_how_made(suite).read};
  };
  const std::string what = files::difference(read_by(before), read_by(after));
  if (what.empty()) return {};
  return {fmt::format("{} and {} were not made of the same files: {}", before.string(),
                      after.string(), what)};
}

fs::path part_of(const std::string& detector, const std::string& own) {
  return detector == own ? fs::path() : fs::path("beside") / detector;
}

void add_part(files::Json& facts, const std::string& shard, const suite::SuiteRuns& runs) {
  std::size_t count = 0;
  files::Json scenarios = files::Json::array();
  for (const auto& [name, seeds] : runs) {
    scenarios.push_back({{"name", name}, {"seeds", seeds}});
    count += seeds.size();
  }
  facts["shard"] = shard;
  facts["runs"] = count;
  facts["scenarios"] = std::move(scenarios);
}

SuiteMade finish_suite(files::Output& folder, const SuitePlace& place, suite::SuiteResult result,
                       std::vector<suite::SuiteResult> others,
                       const std::optional<suite::SuiteResult>& baseline, Caller& caller) {
  for (const suite::SuiteResult& other : others) {
    suite::write_suite(
        folder.staging() / part_of(other.detector, result.detector) / suite::kSuiteFile, other);
  }
  suite::write_suite(folder.staging() / suite::kSuiteFile, result);
  if (!others.empty()) {
    files::write_file(folder.staging() / suite::kStandingFile,
                      suite::standing_page(result, others));
  }
  const suite::SuiteInFolder made{result, folder.staging()};
  std::optional<suite::SuiteInFolder> before;
  std::optional<suite::Comparison> comparison;
  std::optional<report::Against> against;
  if (baseline) {
    before.emplace(suite::SuiteInFolder{*baseline, suite::folder_of(place.baseline)});
    caller.warn(other_inputs(before->folder, folder.staging()));
    comparison = suite::compare(*baseline, result, [](std::string_view) { return true; });
    if (place.allow_missing) comparison->missing.clear();
    against.emplace(report::Against{*before, *comparison});
  }
  const suite::SuiteVerdict verdict = suite::verdict_of(
      made, before ? &*before : nullptr, comparison ? &*comparison : nullptr, others);
  suite::write_junit(folder.staging() / suite::kJunitFile, result, others, verdict);
  report::write_report(folder.staging() / report::kReportFile, made, verdict,
                       against ? &*against : nullptr, others);
  if (!result.split.empty()) {
    const worlds::Split& split = worlds::split(result.split);
    report::write_worlds_page(folder.staging(),
                              fmt::format("The split {} is {}.", split.name, split.purpose), result,
                              others);
  }
  caller.check();
  folder.commit();

  return {.result = std::move(result),
          .others = std::move(others),
          .comparison = std::move(comparison),
          .verdict = verdict,
          .folder = folder.target()};
}

SuiteMade merge(const MergeRequest& request, Caller& caller) {
  std::vector<Part> parts;
  for (const std::string& folder : request.parts) parts.push_back(read_part(folder));
  const suite::SuiteResult result = merged(parts, "");
  std::vector<suite::SuiteResult> others;
  for (const std::string& name : result.beside) {
    others.push_back(merged(parts, part_of(name, result.detector)));
  }
  const files::Provenance provenance = joined(parts, result);
  const std::optional<suite::SuiteResult> baseline = baseline_of(request.place);
  note_longer(request.place.out, request.place.is_named(), "runs",
              provenance.facts.at("runs").get<std::size_t>(), caller);

  files::Output folder(request.place.out, suite::suite_files());
  for (const Part& part : parts) take_files(part, folder.staging(), caller);
  for (const suite::SuiteResult& other : others) {
    fs::create_directories(folder.staging() / part_of(other.detector, result.detector));
  }
  write_how_made(folder.staging(), suite::shell_line(arguments_of(request)), provenance);
  return finish_suite(folder, request.place, result, std::move(others), baseline, caller);
}

}  // namespace lcs::app
