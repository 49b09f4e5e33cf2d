/// \file
/// The counts, samples and times from which a run's metrics are computed.
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "tools/recording/recording.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/score_movers.h"
#include "tools/scoring/score_rebels.h"
#include "tools/scoring/score_squares.h"

namespace lcs::scoring {

/// Counts over the labelled frames after the warm-up.
struct LabelScore {
  int frames = 0;
  int boxes = 0;        ///< labelled boxes, without ignored ones
  int found = 0;        ///< boxes with at least `kCornersToFind` rebel corners in them
  int boxed = 0;        ///< boxes that a moving square matches with an IoU of at least 0.5
  int rebels_off = 0;   ///< rebel corners in no box
  int circles_off = 0;  ///< rebel circles on no box

  void add(const recording::FrameRecord& frame);
};

/// Whether the square moves. A square without circles counts as moving: it is of a user's detector,
/// or of a body that moved before.
bool may_move(const Square& square);

/// A timed stage of a frame's processing.
struct Stage {
  const char* name;  ///< such as "line": column line_ms, metrics time.line_*
  double recording::FrameTimes::*time_ms;
  const char* label = "";     ///< label in tables
  bool is_layer = false;      ///< undefined for a detector without layers
  bool is_of_filter = false;  ///< its time is also compared with FAST's
  bool is_younger = false;    ///< optional column, missing in older files
  std::string column() const { return std::string(name) + "_ms"; }
};

/// In the order of frames.csv and metrics.json.
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

struct Scores {
  recording::DetectorInfo detector;
  int frames = 0;
  RebelCornerScore corners;
  RebelObjectScore objects;
  SquareScore squares;
  MoverScore movers;
  LabelScore labels;
  bool tells_first_sightings = false;  ///< the reason `first_sighting` occurs
  std::set<int> objects_seen;
  std::int64_t rebels_found = 0, movers_found = 0;  ///< right or wrong, over all frames
  std::int64_t edges = 0, rematched_edges = 0;      ///< normal edges; seen in the next frame, too
  /// \name A number for each frame.
  ///@{
  std::vector<double> corner_counts;
  std::vector<double> dimensions;                                 ///< empty without layers
  std::vector<double> rotation_errors_mrad, velocity_errors_mps;  ///< of the estimated motion
  std::vector<recording::FrameTimes> times;                       ///< of frames that have them
  ///@}
  std::vector<recording::Warned> warnings;
};

}  // namespace lcs::scoring
