/// \file
/// The recording of a run: what the filter said and what was true, frame by frame. Scores are computed
/// from it alone, so that a live run, a stored one and a stranger's detector go through the same door.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "filter/layers.h"
#include "sim/truth.h"

namespace lcs::bench {

/// Wall times of one frame.
struct FrameTimes {
  double detect_ms = 0;  ///< `cv::FAST` on this frame: the yardstick
  double line_ms = 0;
  double circle_ms = 0;
  double square_ms = 0;
  double filter_ms = 0;  ///< whole step
};

struct FrameRecord {
  int index = 0;
  std::int64_t t_ns = 0;
  std::vector<Eigen::Vector2f> corners_px;  ///< chi
  std::vector<Verdict> verdicts;            ///< of each corner
  Layers layers;
  std::vector<sim::CornerTruth> corner_truth;  ///< of each corner
  std::vector<sim::ObjectTruth> object_truth;
  FrameTimes times;
};

struct Recording {
  std::string scenario;
  std::uint64_t seed = 0;
  std::vector<sim::Object> objects;
  std::vector<FrameRecord> frames;
  double simulated_frames_per_second = 0;  ///< rendered and scored, wall time
};

}  // namespace lcs::bench
