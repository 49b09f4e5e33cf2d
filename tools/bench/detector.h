/// \file
/// What is under test: a detector, which says of each corner of a frame whether it moves by itself.
/// The LCS filter is one, each comparator another; the bench treats all alike.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "filter/paper/any_filter.h"
#include "scenarios/scenario.h"
#include "sim/pose.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

/// All that a detector is told of a frame.
struct DetectorInput {
  const cv::Mat3b& image;  ///< BGR
  const cv::Mat1b& grey;   ///< the same: what the corners were found in
  std::span<const Eigen::Vector2f> corners_px;
  const EgoMotion& motion;                     ///< since the last frame
  std::span<const Signature> signatures = {};  ///< of each corner; none where none are known
  int index = 0;                               ///< of the frame
  std::int64_t t_ns = 0;                       ///< its time
};

class Detector {
 public:
  virtual ~Detector() = default;

  /// \return a verdict for each corner, in the order given, the layers if there are any, and the
  ///   times of stages. Valid until the next step.
  virtual const FrameResult& step(const DetectorInput& input) = 0;

  /// Whether signatures are to be made for it, which takes longer than to find the corners.
  virtual bool wants_signatures() const { return false; }

  /// The pixels that each square of the last step covers, from a detector that finds them.
  virtual const SquareMasks& masks() const {
    static const SquareMasks kNone;
    return kNone;
  }

  /// Which of a frame's times the time of a step is; null for verdicts that are only read from a
  /// file.
  virtual double FrameTimes::*step_time() const { return &FrameTimes::filter_ms; }

  /// As `DetectorInfo::circles`. Known from the start.
  virtual bool gives_circles() const { return true; }

  /// To be called after the last frame. \throws for what had gone wrong until then.
  virtual void finish() {}

  /// What was wrong with its input so far, if it checks that.
  virtual Diagnostics diagnostics() const { return {}; }

  /// Remarks for people after the last frame, a line each.
  virtual std::vector<std::string> told() const { return {}; }
};

/// The simulator's camera in the form that the filter and all detectors take.
Intrinsics intrinsics(const sim::Pinhole& camera);

/// The LCS filter. It sees corners, their signatures if there are any, and ego-motion, never the
/// image.
class LcsDetector : public Detector {
 public:
  LcsDetector(const Intrinsics& camera, const AnyParameters& parameters)
      : filter_(camera, parameters) {}
  const FrameResult& step(const DetectorInput& input) override {
    if (input.signatures.empty()) return filter_.step(input.corners_px, input.motion);
    return filter_.step(input.corners_px, input.signatures, input.motion);
  }
  bool wants_signatures() const override { return true; }
  Diagnostics diagnostics() const override { return filter_.diagnostics(); }

 private:
  AnyFilter filter_;
};

/// The scenario's preset with its settings on top.
/// \throws scenario::Error at the line of a preset, key or value that the filter does not take.
AnyParameters filter_parameters(const scenario::Scenario& scenario);

}  // namespace lcs::bench
