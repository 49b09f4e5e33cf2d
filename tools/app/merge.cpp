#include "tools/app/merge.h"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/app/how_made.h"
#include "tools/files/output_file.h"
#include "tools/report/worlds_page.h"
#include "tools/suite/merge.h"
#include "tools/suite/suite_run.h"

namespace lcs::app {
namespace {

namespace fs = std::filesystem;

/// Takes the files of a part's runs, of all detectors, and its pictures of worlds.
void take_files(const fs::path& part, const suite::SuiteResult& suite, const fs::path& to,
                Caller& caller) {
  for (const suite::ScenarioResult& scenario : suite.scenarios) {
    for (const suite::RunResult& run : scenario.runs) {
      caller.check();
      if (run.folder.empty()) continue;
      fs::create_directories(to / run.folder);
      for (const fs::directory_entry& file : fs::directory_iterator(part / run.folder)) {
        bench::link_or_copy(file.path(), to / run.folder / file.path().filename());
      }
    }
  }
  if (!fs::exists(part / report::kSheetsFolder)) return;
  fs::create_directories(to / report::kSheetsFolder);
  for (const fs::directory_entry& file : fs::directory_iterator(part / report::kSheetsFolder)) {
    bench::link_or_copy(file.path(), to / report::kSheetsFolder / file.path().filename());
  }
}

/// The parts of one detector. \param within its folder in each part.
class Parts {
 public:
  Parts(const std::vector<std::string>& folders, const fs::path& within) {
    suites_.reserve(folders.size());  // the parts refer to them
    for (const std::string& folder : folders) {
      const fs::path whole = suite::folder_of(folder);
      const fs::path place = within.empty() ? whole : whole / within;
      suites_.push_back(suite::read_suite(place));
      parts_.push_back({suites_.back(), place});
    }
  }
  suite::SuiteResult merged() const { return suite::merge(parts_); }
  void take_files(const fs::path& to, Caller& caller) const {
    for (const suite::SuiteInFolder& part : parts_) {
      app::take_files(part.folder, part.suite, to, caller);
    }
  }

 private:
  std::vector<suite::SuiteResult> suites_;
  std::vector<suite::SuiteInFolder> parts_;
};

}  // namespace

SuiteMade merge(const MergeRequest& request, Caller& caller) {
  const Parts own(request.parts, "");
  const suite::SuiteResult result = own.merged();
  std::vector<Parts> beside;
  std::vector<suite::SuiteResult> others;
  for (const std::string& name : result.beside) {
    beside.emplace_back(request.parts, part_of(name, result.detector));
    others.push_back(beside.back().merged());
  }
  const std::optional<suite::SuiteResult> baseline = baseline_of(request.place);
  std::size_t runs = 0;
  for (const suite::ScenarioResult& scenario : result.scenarios) runs += scenario.runs.size();
  note_longer(request.place.out, request.place.is_named(), "runs", runs, caller);

  bench::Output folder(request.place.out, suite::suite_files());
  own.take_files(folder.staging(), caller);
  for (std::size_t i = 0; i < others.size(); ++i) {
    const fs::path to = folder.staging() / part_of(others[i].detector, result.detector);
    fs::create_directories(to);
    beside[i].take_files(to, caller);
  }
  write_how_made(folder.staging(), suite::shell_line(arguments_of(request)), {}, {{"runs", runs}});
  return finish_suite(folder, request.place, result, std::move(others), baseline, caller);
}

}  // namespace lcs::app
