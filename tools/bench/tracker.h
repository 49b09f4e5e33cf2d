/// \file
/// What is under test: something that says of each corner of a frame whether it moves by itself.
/// The LCS filter is one, a comparator another; the bench treats all alike.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "filter/filter.h"
#include "scenarios/scenario.h"
#include "sim/pose.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

/// All that a tracker is told of a frame.
struct TrackerInput {
  const cv::Mat3b& image;  ///< BGR
  const cv::Mat1b& grey;   ///< the same: what the corners were found in
  std::span<const Eigen::Vector2f> corners_px;
  const EgoMotion& motion;                     ///< since the last frame
  std::span<const Signature> signatures = {};  ///< of each corner; none where none are known
  int index = 0;                               ///< of the frame
  std::int64_t t_ns = 0;                       ///< its time
};

class Tracker {
 public:
  virtual ~Tracker() = default;

  /// \return a verdict for each corner, in the order given, the layers if there are any, and the
  ///   times of stages. Valid until the next step.
  virtual const FrameResult& step(const TrackerInput& input) = 0;

  /// Whether signatures are to be made for it, which takes longer than to find the corners.
  virtual bool wants_signatures() const { return false; }

  /// What the squares of the last step cover, of a tracker that says so pixel by pixel.
  virtual const SquareMasks& masks() const {
    static const SquareMasks kNone;
    return kNone;
  }

  /// Which of a frame's times a step takes; null where it takes none, as what it says was read.
  virtual double FrameTimes::*step_time() const { return &FrameTimes::filter_ms; }

  /// As `DetectorInfo::circles`. Known from the start.
  virtual bool gives_circles() const { return true; }

  /// To be called after the last frame. \throws for what was wrong with it until then.
  virtual void finish() {}

  /// What was wrong with what it was told so far, if it looks.
  virtual Diagnostics diagnostics() const { return {}; }

  /// What else there is to tell of it after the last frame: a line for people each.
  virtual std::vector<std::string> told() const { return {}; }
};

/// The simulator's camera, which knows nothing of the filter, as the filter and all trackers take
/// it: the one place where one becomes the other.
Intrinsics intrinsics(const sim::Pinhole& camera);

/// The LCS filter. It sees corners, their signatures if there are any, and ego-motion, never the
/// image.
class LcsTracker : public Tracker {
 public:
  LcsTracker(const Intrinsics& camera, const Parameters& parameters);
  const FrameResult& step(const TrackerInput& input) override;
  bool wants_signatures() const override { return true; }
  Diagnostics diagnostics() const override { return filter_.diagnostics(); }

 private:
  Filter filter_;
};

/// The scenario's preset with its settings on top.
/// \throws scenario::Error at the line of a preset, key or value that the filter does not take.
Parameters filter_parameters(const scenario::Scenario& scenario);

/// A line for each of the scenario's settings of the filter that changes nothing, as it is of a
/// rule that is not in use. \throws as `filter_parameters`.
std::vector<std::string> idle_settings(const scenario::Scenario& scenario);

}  // namespace lcs::bench
