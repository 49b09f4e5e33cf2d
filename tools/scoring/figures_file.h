/// \file
/// Reads and writes the files with a run's figures.
#pragma once

#include <filesystem>

#include "tools/files/output_file.h"
#include "tools/recording/recording.h"
#include "tools/scoring/scoring.h"

namespace lcs::bench {

inline constexpr const char* kMetricsFile = "metrics.json";
inline constexpr const char* kFramesFile = "frames.csv";

/// Writes flat JSON; an undefined figure is null. \throws OutputError
void write_metrics(const std::filesystem::path& path, const Metrics& metrics);

/// Reads a file of `write_metrics`; figures are restored exactly.
/// \throws std::runtime_error that names the file and the fault.
Metrics read_metrics(const std::filesystem::path& path);

/// Writes a header and a row per frame: sizes, counts of rebels, precision and recall (empty if
/// undefined), times in ms (empty if the recording has none). Numbers have the shortest form that
/// parses to the same bits. \throws OutputError; std::invalid_argument as `score`.
void write_frames(const std::filesystem::path& path, const Recording& recording);

/// Restores the times of a stored recording's frames from its `frames.csv`.
/// \throws std::runtime_error that names the file, the line and the fault.
void read_times(const std::filesystem::path& frames_csv, Recording& recording);

}  // namespace lcs::bench
