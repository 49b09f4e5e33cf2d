/// \file
/// The timed stages of a frame's processing, in the order of frames.csv and metrics.json.
#pragma once

#include <string>

#include "tools/recording/recording.h"

namespace lcs::bench {

struct Stage {
  const char* name;  ///< such as "line": column line_ms, metrics time.line_*
  double FrameTimes::*time_ms;
  const char* label = "";     ///< label in tables
  bool is_layer = false;      ///< undefined for a detector without layers
  bool is_of_filter = false;  ///< its time is also compared with FAST's
  bool is_younger = false;    ///< optional column, missing in older files
  std::string column() const { return std::string(name) + "_ms"; }
};

inline constexpr Stage kStages[] = {
    {"detect", &FrameTimes::detect_ms, "FAST"},
    {"describe", &FrameTimes::describe_ms, "signatures", false, false, true},
    {"line", &FrameTimes::line_ms, "line", true, true},
    {"circle", &FrameTimes::circle_ms, "circle", true, true},
    {"square", &FrameTimes::square_ms, "square", true, true},
    {"filter", &FrameTimes::filter_ms, "filter", false, true},
    {"process", &FrameTimes::process_ms, "process", false, false, true},
    {"simulate", &FrameTimes::simulate_ms},
    {"truth", &FrameTimes::truth_ms},
};

}  // namespace lcs::bench
