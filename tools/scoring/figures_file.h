/// \file
/// Reads and writes the files with a run's figures.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

#include "scenarios/input/input_file.h"
#include "tools/files/output_file.h"
#include "tools/recording/recording.h"
#include "tools/scoring/scoring.h"

namespace lcs::scoring {

inline constexpr const char* kMetricsFile = "metrics.json";
inline constexpr const char* kFramesFile = "frames.csv";

/// Writes flat JSON; an undefined figure is null. \throws OutputError
void write_metrics(const std::filesystem::path& path, const Metrics& metrics);

/// Reads a file of `write_metrics`; figures are restored exactly.
/// \throws std::runtime_error that names the file and the fault.
Metrics read_metrics(const std::filesystem::path& path);

/// Writes a header and a row per frame: sizes, counts of rebels, precision and recall (empty if
/// undefined), times in ms (empty if the frame has none). Numbers have the shortest form that
/// parses to the same bits.
class FramesWriter {
 public:
  /// Uses the detector and the truth of the run. \throws OutputError
  FramesWriter(const std::filesystem::path& path, const recording::RunInfo& run);
  /// \throws OutputError
  void write(const recording::FrameRecord& frame, const RebelCounts& rebels);
  /// \throws OutputError
  void close() { file_.close(); }

 private:
  files::OutputFile file_;
  bool is_layered_, is_truth_known_;
};

/// Restores the times of a stored recording's frames from its `frames.csv`, in order.
class TimesReader {
 public:
  /// \throws std::runtime_error that names the file, the line and the fault, as the others.
  explicit TimesReader(const std::filesystem::path& frames_csv);
  void read(recording::FrameRecord& frame);
  /// To be called after the last frame. \throws also for further rows.
  void finish();

 private:
  [[noreturn]] void fail(const std::string& what) const;

  input::InputFile file_;
  std::string header_line_;
  std::vector<std::string_view> header_;  ///< in `header_line_`
  int line_ = 1;
};

}  // namespace lcs::scoring
