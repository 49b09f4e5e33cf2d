/// \file
/// The files that hold a run's figures.
#pragma once

#include <filesystem>

#include "tools/bench/output_file.h"
#include "tools/bench/recording.h"
#include "tools/bench/scoring.h"

namespace lcs::bench {

inline constexpr const char* kMetricsFile = "metrics.json";
inline constexpr const char* kFramesFile = "frames.csv";

/// Flat JSON, null for what is undefined. \throws OutputError
void write_metrics(const std::filesystem::path& path, const Metrics& metrics);

/// What `write_metrics` wrote, to the last bit.
/// \throws std::runtime_error naming file and what is wrong with it.
Metrics read_metrics(const std::filesystem::path& path);

/// A header and a row a frame: sizes, counts of rebels, precision and recall (empty where
/// undefined), times in ms (empty for a recording without). \throws OutputError;
/// std::invalid_argument as `score`.
void write_frames(const std::filesystem::path& path, const Recording& recording);

}  // namespace lcs::bench
