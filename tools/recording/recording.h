/// \file
/// The recording of a run: detections and truth, frame by frame. Scores are computed from it alone,
/// in the same way for a live run, a stored run and any other detector's output.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "filter/kinematics/camera.h"
#include "filter/kinematics/ego_motion.h"
#include "filter/types/gap.h"
#include "filter/types/layers.h"
#include "filter/types/paper_layers.h"
#include "filter/types/reason.h"
#include "filter/types/signature.h"
#include "scenarios/scenario.h"
#include "sim/truth/mask.h"
#include "sim/truth/truth.h"
#include "sim/world/warnings.h"
#include "tools/recording/labels.h"

namespace lcs::recording {

/// Sightings needed for a rebel verdict (N in the paper): the warm-up, and one more than the least
/// latency.
inline constexpr int kSightings = 3;

/// Wall times of one frame; the only part of a recording that differs between two equal runs. 0 for
/// steps that were not run, for example if the corners come from an earlier run.
struct FrameTimes {
  double simulate_ms = 0;  ///< physics and rendering
  double detect_ms = 0;    ///< `cv::FAST` on this frame: the reference time
  double describe_ms = 0;  ///< signatures of its corners
  double line_ms = 0;
  double circle_ms = 0;
  double square_ms = 0;
  double filter_ms = 0;   ///< the filter's whole step
  double process_ms = 0;  ///< whole step of a detector in another process, transfer included
  double truth_ms = 0;    ///< labelling of the corners
};

/// The pixels of squares, by square id, from a detector that provides them.
using SquareMasks = std::map<Id, sim::Mask>;

struct FrameRecord {
  int index = 0;
  std::int64_t t_ns = 0;
  std::vector<Eigen::Vector2f> corners_px;  ///< chi, in pixels
  std::vector<Signature> signatures;        ///< of each corner; empty if not computed
  std::vector<Verdict> verdicts;            ///< of each corner
  std::vector<Reason> reasons;              ///< of each verdict; empty if not given
  /// Of each corner, in steps of .01: log odds that it moves by itself; empty if not given.
  std::vector<float> log_odds;
  Layers layers;
  PaperLayers paper;  ///< empty except for the paper's filter
  SquareMasks masks;
  /// Answers of the picture to the filter; absent if it did not look at pictures.
  std::optional<std::vector<GapSeen>> gaps;
  EgoMotion motion;       ///< since the previous frame, as given to the detector
  EgoMotion true_motion;  ///< since the previous frame, from the exact poses
  std::vector<sim::CornerTruth> corner_truth;  ///< of each corner
  std::vector<sim::ObjectTruth> object_truth;
  /// All moving objects in the frame, if it was labelled.
  std::optional<std::vector<LabelledBox>> labels;
  std::optional<FrameTimes> times;  ///< absent in a stored recording
};

/// How much of the truth is known, and therefore can be scored.
enum class Truth : std::uint8_t {
  all,            ///< known for every corner and object, as in a simulation
  nothing_moves,  ///< every corner is fixed; the objects are unknown
  unknown,        ///< only `FrameRecord::labels`, if present
};

/// The detector whose verdicts a recording holds.
struct DetectorInfo {
  std::string name = "lcs";
  /// It is the filter: its layers are its whole memory, so their size is a metric. False for
  /// comparators and other detectors, whose layers only hold their results.
  bool layered = true;
  /// It groups rebels into circles, from which false objects are counted. False for a detector
  /// without circles.
  bool circles = true;
};

/// The facts that all frames of a run share.
struct RunInfo {
  std::string scenario;
  std::uint64_t seed = 0;
  /// `scenario::Scenario::world`, to detect later changes of the scenario's world; empty if there
  /// is no scenario world.
  std::map<std::string, std::string> world;
  /// Family and seed of the frames' world; absent if unknown.
  std::optional<scenario::Origin> origin = {};
  DetectorInfo detector;
  std::optional<Intrinsics> camera = {};  ///< as given to detectors
  Truth truth = Truth::all;
  std::vector<sim::Object> objects;
  /// The simulation's warnings in the whole run; absent without a simulation.
  std::optional<sim::Warnings> warnings = {};
};

/// A whole run in memory, about 0.2 MB a frame. A run of unknown length is handed on frame by
/// frame.
struct Recording : RunInfo {
  std::vector<FrameRecord> frames;  ///< by index
};

/// Sets the truth of a frame's corners where no simulation provides it.
/// \param frame contains its corners. \param truth not `all`.
void set_corner_truth(Truth truth, FrameRecord& frame);

/// Moves the detector's input and the truth on, without verdicts, layers, masks and times.
FrameRecord without_detections(FrameRecord frame);
Recording without_detections(Recording recording);

}  // namespace lcs::recording
