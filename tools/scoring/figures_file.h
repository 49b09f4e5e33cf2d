/// \file
/// The files that hold a run's figures.
#pragma once

#include <filesystem>

#include "tools/files/output_file.h"
#include "tools/recording/recording.h"
#include "tools/scoring/scoring.h"

namespace lcs::bench {

inline constexpr const char* kMetricsFile = "metrics.json";
inline constexpr const char* kFramesFile = "frames.csv";

/// Flat JSON, null for what is undefined. \throws OutputError
void write_metrics(const std::filesystem::path& path, const Metrics& metrics);

/// What `write_metrics` wrote, to the last bit.
/// \throws std::runtime_error naming file and what is wrong with it.
Metrics read_metrics(const std::filesystem::path& path);

/// A header and a row a frame: sizes, counts of rebels, precision and recall (empty where
/// undefined), times in ms (empty for a recording without). Numbers are in the shortest form that
/// reads back to the same bits. \throws OutputError; std::invalid_argument as `score`.
void write_frames(const std::filesystem::path& path, const Recording& recording);

/// Restores the times of a stored recording's frames from its `frames.csv`.
/// \throws std::runtime_error naming file, line and what is wrong there.
void read_times(const std::filesystem::path& frames_csv, Recording& recording);

}  // namespace lcs::bench
