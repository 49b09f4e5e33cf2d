#include "tools/lcs/merge.h"

#include <fmt/format.h>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>

#include "tools/files/output_file.h"
#include "tools/lcs/how_made.h"
#include "tools/lcs/interrupt.h"
#include "tools/report/worlds_page.h"
#include "tools/suite/merge.h"
#include "tools/suite/suite_run.h"

namespace lcs::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHelp = R"(Examples:
  lcs suite --worlds train --count 1000 --shard 1/2 --out part1     on one machine
  lcs suite --worlds train --count 1000 --shard 2/2 --out part2     on another
  lcs merge part1 part2 --out out/train

The merged suite has the files of a suite that was made in one go: figures, report, JUnit, tables. The parts
stay as they are. On one file system their runs are linked, not copied.

Exit codes: as of lcs suite. 2 also where a part is missing or is of another suite.
)";

/// Takes the files of a part's runs, of all detectors, and its pictures of worlds.
void take_files(const fs::path& part, const suite::SuiteResult& suite, const fs::path& to) {
  for (const suite::ScenarioResult& scenario : suite.scenarios) {
    for (const suite::RunResult& run : scenario.runs) {
      check_interrupted();
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
  void take_files(const fs::path& to) const {
    for (const suite::SuiteInFolder& part : parts_) {
      tools::take_files(part.folder, part.suite, to);
    }
  }

 private:
  std::vector<suite::SuiteResult> suites_;
  std::vector<suite::SuiteInFolder> parts_;
};

}  // namespace

CLI::App& add_merge_command(CLI::App& app, MergeOptions& options) {
  CLI::App& command = *app.add_subcommand(
      "merge", "Join the parts of a suite that several machines made (lcs suite --shard)");
  command.add_option("DIR", options.parts, "The folders of all parts")->required()->type_name("");
  add_suite_end_options(command, options.end);
  command.footer(kHelp);
  return command;
}

ExitCode merge(const MergeOptions& options) {
  const Parts own(options.parts, "");
  const suite::SuiteResult result = own.merged();
  std::vector<Parts> beside;
  std::vector<suite::SuiteResult> others;
  for (const std::string& name : result.beside) {
    beside.emplace_back(options.parts, part_of(name, result.detector));
    others.push_back(beside.back().merged());
  }
  const std::optional<suite::SuiteResult> baseline = baseline_of(options.end);
  std::size_t runs = 0;
  for (const suite::ScenarioResult& scenario : result.scenarios) runs += scenario.runs.size();
  note_longer(options.end.out, options.end.is_named(), "runs", runs);

  bench::Output folder(options.end.out, suite::suite_files());
  own.take_files(folder.staging());
  for (std::size_t i = 0; i < others.size(); ++i) {
    const fs::path to = folder.staging() / part_of(others[i].detector, result.detector);
    fs::create_directories(to);
    beside[i].take_files(to);
  }
  write_how_made(folder.staging(), suite::shell_line(command_line()), {}, {{"runs", runs}});
  return finish_suite(folder, options.end, result, others, baseline);
}

}  // namespace lcs::tools
