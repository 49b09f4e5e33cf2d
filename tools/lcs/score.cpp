/// \file
/// `lcs score`: computes a run's figures from its files, for its own or another detector.
#include <fmt/format.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/output.h"
#include "tools/input/message.h"
#include "tools/lcs/commands.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/options.h"
#include "tools/lcs/terminal.h"
#include "tools/output/table.h"
#include "tools/recording/detections.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/figures_file.h"
#include "tools/scoring/scoring.h"
#include "tools/suite/suite_result.h"
#include "tools/suite/suite_table.h"

namespace lcs::tools {
namespace {

struct ScoreOptions {
  std::string sequence;          ///< folder of a run
  std::string detections;        ///< CSV file; "": score the run's own detector
  std::string out;               ///< file for the figures; "": none
  std::string write_detections;  ///< CSV file for the verdicts; "": none
  bool force = false;
  bool quiet = false;
};

constexpr const char* kHelp = R"(Examples:
  lcs score out/crossing                                    a run's figures again
  lcs score out/suite                                       those of all runs of a suite
  lcs score out/crossing --detections mine.csv              another detector's on the same frames
  lcs score out/crossing --detections mine.csv --out mine.json
  lcs score out/crossing --write-detections lcs.csv         what the run's detector said, as CSV

A row of detections is one of these; corners that no row names are normal
(tools/recording/DETECTIONS.md has all of it, and how to write them from Python):
  FRAME,rebel,X,Y                        or normal, pending, ignored; or FRAME,rebel,INDEX
  FRAME,box,ID,LEFT,TOP,WIDTH,HEIGHT     an object, in pixels
  FRAME,mask,ID,HEIGHT,WIDTH,COUNTS      the same by COCO's RLE
  FRAME,circle,X,Y,RADIUS                a group of rebels, by which false objects are counted;
                                         without values: there is none in this frame

Of the run's folder, layers.jsonl (for its corners), truth.jsonl and, for the times, frames.csv are
read; none of it is changed. Figures are those of tools/scoring/SCORING.md. The times of the run's own
detector are those of the run; someone else's has none, nor a dimension.

Exit codes:
  0  fine
  2  error: file and line, what is wrong, what to do; nothing was written
)";

bench::Recording read_run(const std::filesystem::path& folder) {
  if (!std::filesystem::is_directory(folder)) {
    throw std::runtime_error(
        fmt::format("{} is no folder; name one that lcs run has left", folder.string()));
  }
  bench::Recording recording = bench::read_recording(folder);
  // The file is optional; without it the recording has no times.
  const std::filesystem::path frames_csv = folder / bench::kFramesFile;
  if (std::filesystem::exists(frames_csv)) bench::read_times(frames_csv, recording);
  return recording;
}

/// Scores every run of a suite again and prints the table of `lcs suite`.
ExitCode score_suite(const ScoreOptions& options) {
  if (!options.detections.empty() || !options.out.empty() || !options.write_detections.empty()) {
    throw std::invalid_argument(fmt::format(
        "{0} is a suite, of which figures are only printed; for detections there is lcs suite "
        "--recorded {0} --detections DIR, or name a run in its runs/",
        options.sequence));
  }
  const std::filesystem::path folder = options.sequence;
  suite::SuiteResult suite = suite::read_suite(folder);
  for (suite::ScenarioResult& scenario : suite.scenarios) {
    for (suite::RunResult& run : scenario.runs) {
      check_interrupted();
      if (run.outcome != suite::Outcome::error) {
        run.metrics = bench::score(read_run(folder / run.folder));
      }
    }
  }
  if (!options.quiet) print_out("{}", suite::suite_table(suite, false));
  return kFine;
}

ExitCode score(const ScoreOptions& options) {
  if (std::filesystem::exists(std::filesystem::path(options.sequence) / suite::kSuiteFile)) {
    return score_suite(options);
  }
  bench::Recording recording = read_run(options.sequence);
  if (!options.detections.empty()) {
    bench::Detections detections = bench::read_detections(options.detections, recording);
    for (const std::string& line : bench::lines_of(detections.counts)) tell(line);
    recording = std::move(detections.recording);
  }
  std::vector<bench::Output*> outputs;
  std::optional<bench::Output> figures, verdicts;
  const auto add = [&](std::optional<bench::Output>& output, const std::string& file) {
    if (!file.empty()) outputs.push_back(&output.emplace(file, overwrite(options.force)));
  };
  add(figures, options.out);
  add(verdicts, options.write_detections);
  const bench::Metrics metrics = bench::score(recording);
  check_interrupted();
  if (figures) bench::write_metrics(figures->staging(), metrics);
  if (verdicts) bench::write_detections(verdicts->staging(), recording);
  bench::commit_all(outputs);
  if (!options.quiet) {
    print_out("{}\n{}",
              input::one_line(fmt::format("{} by {}: {} frames, seed {}", recording.scenario,
                                          recording.detector.name, recording.frames.size(),
                                          recording.seed)),
              bench::table(metrics));
  }
  return kFine;
}

}  // namespace

Command add_score_command(CLI::App& app) {
  const auto owned = std::make_shared<ScoreOptions>();
  ScoreOptions& options = *owned;
  CLI::App& command = *app.add_subcommand(
      "score", "Score a run by its files, or someone else's detector on the same frames");
  command.add_option("--sequence,DIR", options.sequence, "Folder of a run, or of a suite")
      ->required()
      ->type_name("");
  command
      .add_option("--detections", options.detections,
                  "Score what this CSV file says instead of the run's own detector")
      ->type_name("FILE");
  add_output_file_option(command, "--out", options.out, options.force,
                         "Write the figures to this file, as metrics.json has them");
  add_output_file_option(command, "--write-detections", options.write_detections, options.force,
                         "Write the verdicts and boxes that are scored to this CSV file");
  add_quiet_option(command, options.quiet);
  command.footer(kHelp);
  return {command, [owned] { return score(*owned); }};
}

}  // namespace lcs::tools
