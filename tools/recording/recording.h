/// \file
/// The recording of a run: what the detector found and what was true, frame by frame. Scores are
/// computed from it alone, in the same way for a live run, a stored one, and any other detector's
/// output.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/layers.h"
#include "filter/reason.h"
#include "filter/signature.h"
#include "scenarios/scenario.h"
#include "sim/mask.h"
#include "sim/truth.h"
#include "sim/warnings.h"
#include "tools/recording/labels.h"

namespace lcs::bench {

/// Sightings that a rebel needs (the paper's N): warm-up, and the floor of latency plus one.
inline constexpr int kSightings = 3;

/// Wall times of one frame. The only part of a recording that differs between two runs. 0 for what
/// was not done, as when the corners are those of an earlier run.
struct FrameTimes {
  double simulate_ms = 0;  ///< physics and rendering
  double detect_ms = 0;    ///< `cv::FAST` on this frame: the yardstick
  double describe_ms = 0;  ///< signatures of its corners
  double line_ms = 0;
  double circle_ms = 0;
  double square_ms = 0;
  double filter_ms = 0;   ///< whole step
  double process_ms = 0;  ///< likewise of a detector that is a process, the transfer to it included
  double truth_ms = 0;    ///< labelling of the corners
};

/// The pixels that squares cover, by the squares' ids, from a detector that finds them.
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
  EgoMotion motion;                            ///< since the last frame, as the detector was told
  EgoMotion true_motion;                       ///< likewise, from the exact poses
  std::vector<sim::CornerTruth> corner_truth;  ///< of each corner
  std::vector<sim::ObjectTruth> object_truth;
  /// All that moves in the frame, if somebody labelled it.
  std::optional<std::vector<LabelledBox>> labels;
  std::optional<FrameTimes> times;  ///< none in a recording that was stored
};

/// How much of the truth is known, and so what can be scored.
enum class Truth : std::uint8_t {
  all,            ///< that of every corner and object, as in a simulation
  nothing_moves,  ///< every corner is fixed; nothing is known of objects
  unknown,        ///< nothing but `FrameRecord::labels`, if there are any
};

/// The detector whose verdicts a recording holds.
struct DetectorInfo {
  std::string name = "lcs";
  /// It is the filter: the layers are all that it keeps of former frames, so that their size is a
  /// figure. False for comparators and other detectors, whose layers only carry their results.
  bool layered = true;
  /// It groups rebels into circles, from which false objects are counted. False for a detector that
  /// has not given any.
  bool circles = true;
};

struct Recording {
  std::string scenario;
  std::uint64_t seed = 0;
  /// `scenario::Scenario::world`, to tell whether the scenario's world has changed since; empty
  /// where there is none.
  std::map<std::string, std::string> world;
  /// The world that the frames are of: its family and seed; none if it is not known.
  std::optional<scenario::Origin> origin = {};
  DetectorInfo detector;
  std::optional<Intrinsics> camera = {};  ///< as detectors are told of it
  Truth truth = Truth::all;
  std::vector<sim::Object> objects;
  std::vector<FrameRecord> frames;  ///< by index
  /// The simulation's warnings in the whole run; none where nothing was simulated.
  std::optional<sim::Warnings> warnings = {};
};

/// Sets the truth of a frame's corners from what is known without a simulation.
/// \param frame with its corners. \param truth not `all`.
void set_corner_truth(Truth truth, FrameRecord& frame);

/// The recording without the detector's verdicts, layers and times: what there was to see, and the
/// truth.
Recording without_detections(const Recording& recording);

}  // namespace lcs::bench
