#include "tools/lcs/score.h"

#include <fmt/format.h>

#include <filesystem>

#include "scenarios/message.h"
#include "tools/bench/detections.h"
#include "tools/bench/recording_io.h"
#include "tools/bench/report.h"
#include "tools/bench/scoring.h"
#include "tools/bench/table.h"
#include "tools/lcs/interrupt.h"
#include "tools/lcs/terminal.h"

namespace lcs::tools {
namespace {

constexpr const char* kHelp = R"(Examples:
  lcs score out/crossing                                    a run's figures again
  lcs score out/crossing --detections mine.csv              another detector's on the same frames
  lcs score out/crossing --detections mine.csv --out mine.json
  lcs score out/crossing --write-detections lcs.csv         what the run's detector said, as CSV

A row of detections is one of these; corners that no row names are normal
(tools/bench/DETECTIONS.md has all of it, and how to write them from Python):
  FRAME,rebel,X,Y                        or normal, pending, ignored; or FRAME,rebel,INDEX
  FRAME,box,ID,LEFT,TOP,WIDTH,HEIGHT     an object, in pixels
  FRAME,circle,X,Y,RADIUS                a group of rebels: counts for false objects

Of the run's folder, layers.jsonl (for its corners), truth.jsonl and, for the times, frames.csv are
read; none of it is changed. Figures are those of tools/bench/SCORING.md. The times of the run's own
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
  // Recordings may be handed on without: then there are no times.
  const std::filesystem::path frames_csv = folder / bench::kFramesFile;
  if (std::filesystem::exists(frames_csv)) bench::read_times(frames_csv, recording);
  return recording;
}

void report_unmatched(const bench::Detections& detections) {
  if (detections.without_corner > 0) {
    print_err("{} of {} verdicts are on no corner: there is none within {} px\n",
              detections.without_corner, detections.verdicts, bench::kCornerReach_px);
  }
  if (detections.repeated > 0) {
    print_err("{} of {} verdicts are on a corner that has one already: the first holds\n",
              detections.repeated, detections.verdicts);
  }
}

/// Detections that were read are somebody's own.
void require_other_file(const std::filesystem::path& out, const std::filesystem::path& in) {
  std::error_code is_not_there;
  if (in.empty() || !std::filesystem::equivalent(out, in, is_not_there)) return;
  throw bench::OutputError(fmt::format(
      "{} is the file that is scored; choose another one with --write-detections", out.string()));
}

}  // namespace

CLI::App& add_score_command(CLI::App& app, ScoreOptions& options) {
  CLI::App& command = *app.add_subcommand(
      "score", "Score a run by its files, or someone else's detector on the same frames");
  command.add_option("--sequence,DIR", options.sequence, "Folder of a run")
      ->required()
      ->type_name("");
  command
      .add_option("--detections", options.detections,
                  "Score what this CSV file says instead of the run's own detector")
      ->type_name("FILE");
  command
      .add_option("--out", options.out, "Write the figures to this file, as metrics.json has them")
      ->type_name("FILE");
  command
      .add_option("--write-detections", options.write_detections,
                  "Write the verdicts and boxes that are scored to this CSV file")
      ->type_name("FILE");
  command.add_flag("--quiet", options.quiet, "Print nothing but what went wrong");
  command.footer(kHelp);
  return command;
}

ExitCode score(const ScoreOptions& options) {
  bench::Recording recording = read_run(options.sequence);
  if (!options.detections.empty()) {
    bench::Detections detections = bench::read_detections(options.detections, recording);
    report_unmatched(detections);
    recording = std::move(detections.recording);
  }
  const bench::Metrics metrics = bench::score(recording);

  check_interrupted();
  if (!options.out.empty()) {
    bench::write_whole(
        options.out,
        [&](const std::filesystem::path& path) { bench::write_metrics(path, metrics); },
        bench::kMetricsSign);
  }
  if (!options.write_detections.empty()) {
    require_other_file(options.write_detections, options.detections);
    bench::write_whole(
        options.write_detections,
        [&](const std::filesystem::path& path) { bench::write_detections(path, recording); },
        bench::kDetectionsHeader);
  }
  if (!options.quiet) {
    print_out("{}\n{}",
              scenario::one_line(fmt::format("{} by {}: {} frames, seed {}", recording.scenario,
                                             recording.detector.name, recording.frames.size(),
                                             recording.seed)),
              bench::table(metrics));
  }
  return kFine;
}

}  // namespace lcs::tools
