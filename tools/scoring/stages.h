/// \file
/// The timed stages of a frame's processing, in the order of frames.csv and metrics.json.
#pragma once

#include <string>

#include "tools/recording/recording.h"

namespace lcs::scoring {

struct Stage {
  const char* name;  ///< such as "line": column line_ms, metrics time.line_*
  double recording::FrameTimes::*time_ms;
  const char* label = "";     ///< label in tables
  bool is_layer = false;      ///< undefined for a detector without layers
  bool is_of_filter = false;  ///< its time is also compared with FAST's
  bool is_younger = false;    ///< optional column, missing in older files
  std::string column() const { return std::string(name) + "_ms"; }
};

inline constexpr Stage kStages[] = {
    {"detect", &recording::FrameTimes::detect_ms, "FAST"},
    {"describe", &recording::FrameTimes::describe_ms, "signatures", false, false, true},
    {"line", &recording::FrameTimes::line_ms, "line", true, true},
    {"circle", &recording::FrameTimes::circle_ms, "circle", true, true},
    {"square", &recording::FrameTimes::square_ms, "square", true, true},
    {"filter", &recording::FrameTimes::filter_ms, "filter", false, true},
    {"process", &recording::FrameTimes::process_ms, "process", false, false, true},
    {"simulate", &recording::FrameTimes::simulate_ms},
    {"truth", &recording::FrameTimes::truth_ms},
};

}  // namespace lcs::scoring
