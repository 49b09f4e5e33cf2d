/// \file
/// The recording of a run: what the filter said and what was true, frame by frame. Scores are
/// computed from it alone, so that a live run, a stored one and a stranger's detector go through
/// the same door.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "filter/ego_motion/ego_motion.h"
#include "filter/kinematics/camera.h"
#include "filter/layers.h"
#include "filter/reason.h"
#include "filter/signature.h"
#include "sim/mask.h"
#include "sim/truth.h"
#include "sim/warnings.h"
#include "tools/recording/labels.h"

namespace lcs::bench {

/// Sightings that a rebel needs (the paper's N): warm-up, and the floor of latency plus one.
inline constexpr int kSightings = 3;

/// Wall times of one frame. The only part of a recording that differs between two runs. 0 for what
/// was not done, as where corners are those of an earlier run.
struct FrameTimes {
  double simulate_ms = 0;  ///< physics and rendering
  double detect_ms = 0;    ///< `cv::FAST` on this frame: the yardstick
  double describe_ms = 0;  ///< signatures of its corners
  double line_ms = 0;
  double circle_ms = 0;
  double square_ms = 0;
  double filter_ms = 0;   ///< whole step
  double process_ms = 0;  ///< likewise of a detector that is a process: what it is handed included
  double truth_ms = 0;    ///< labelling of the corners
};

/// What squares cover, pixel by pixel, by their ids: of a detector that says so.
using SquareMasks = std::map<Id, sim::Mask>;

struct FrameRecord {
  int index = 0;
  std::int64_t t_ns = 0;
  std::vector<Eigen::Vector2f> corners_px;  ///< chi
  std::vector<Signature> signatures;        ///< of each corner; empty where none were made
  std::vector<Verdict> verdicts;            ///< of each corner
  std::vector<Reason> reasons;              ///< of each verdict; empty where none are given
  Layers layers;
  SquareMasks masks;
  EgoMotion motion;                            ///< since the last frame, as the tracker was told
  EgoMotion true_motion;                       ///< likewise, from the exact poses
  std::vector<sim::CornerTruth> corner_truth;  ///< of each corner
  std::vector<sim::ObjectTruth> object_truth;
  /// Of a frame that somebody labelled: all that moves in it.
  std::optional<std::vector<LabelledBox>> labels;
  std::optional<FrameTimes> times;  ///< none in a recording that was stored
};

/// What is known of corners and objects, by which they can be scored.
enum class Truth : std::uint8_t {
  all,            ///< of every corner and object: it was simulated
  nothing_moves,  ///< that every corner is fixed; of objects nothing
  unknown,        ///< nothing but `FrameRecord::labels`, where there are some
};

/// The detector whose verdicts a recording holds.
struct DetectorInfo {
  std::string name = "lcs";
  /// Its stages and layers are the filter's: the layers are all that it remembers of former frames,
  /// so that their size is a figure. False for a comparator or a stranger's detector, which give
  /// boxes and no more.
  bool layered = true;
  /// It groups rebels to circles, by which false objects are counted. False for a stranger's
  /// detector that has not said so.
  bool circles = true;
};

struct Recording {
  std::string scenario;
  std::uint64_t seed = 0;
  /// `scenario::Scenario::world`, by which it is known whether the scenario is still the same;
  /// empty where there is none.
  std::map<std::string, std::string> world;
  DetectorInfo detector;
  std::optional<Intrinsics> camera = {};  ///< as detectors are told of it
  Truth truth = Truth::all;
  std::vector<sim::Object> objects;
  std::vector<FrameRecord> frames;  ///< by index
  /// Of the world, until after the last frame; none where nobody looked.
  std::optional<sim::Warnings> warnings = {};
};

/// Says of each corner of a frame what is known of it if no simulation does.
/// \param frame with its corners. \param truth not `all`.
void set_corner_truth(Truth truth, FrameRecord& frame);

/// What there was to see and what was true, without a detector's verdicts, layers and times.
Recording without_detections(const Recording& recording);

}  // namespace lcs::bench
