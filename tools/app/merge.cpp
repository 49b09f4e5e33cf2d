#include "tools/app/suite.h"

#include <fmt/format.h>

#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

#include "scenarios/input/message.h"
#include "tools/app/how_made.h"
#include "tools/files/output.h"
#include "tools/files/written.h"
#include "tools/report/report_page.h"
#include "tools/suite/parts.h"
#include "tools/suite/suite_run.h"

namespace lcs::app {
namespace {

namespace fs = std::filesystem;

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
