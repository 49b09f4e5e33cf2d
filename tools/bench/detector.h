/// \file
/// Interface of the programs under test. A detector decides for each corner of a frame whether it
/// moves by itself. The LCS filter and all comparators implement it.
#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <opencv2/core.hpp>
#include <span>
#include <string>
#include <vector>

#include "filter/detect/gap_picture.h"
#include "filter/paper/any_filter.h"
#include "scenarios/scenario.h"
#include "sim/base/pose.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

/// A detector's input for one frame.
struct DetectorInput {
  const cv::Mat3b& image;  ///< BGR
  const cv::Mat1b& grey;   ///< grey image, input of corner detection
  std::span<const Eigen::Vector2f> corners_px;
  const EgoMotion& motion;                     ///< since the last frame
  std::span<const Signature> signatures = {};  ///< of each corner; empty if unknown
  int index = 0;                               ///< frame number
  std::int64_t t_ns = 0;                       ///< frame time
  /// What an earlier run has seen in gaps, in place of a picture; null: unknown.
  const std::vector<GapSeen>* gaps = nullptr;
};

class Detector {
 public:
  virtual ~Detector() = default;

  /// \return a verdict for each corner, in the order given, layers if any, and times of stages.
  ///   Valid until the next step.
  virtual const FrameResult& step(const DetectorInput& input) = 0;

  /// Whether it uses signatures, which take longer to compute than corners.
  virtual bool wants_signatures() const { return false; }

  /// Pixel masks of the last step's squares, if the detector finds masks.
  virtual const recording::SquareMasks& masks() const {
    static const recording::SquareMasks kNone;
    return kNone;
  }

  /// The field of `FrameTimes` for its step time; null if verdicts are only read from a file.
  virtual double recording::FrameTimes::*step_time() const {
    return &recording::FrameTimes::filter_ms;
  }

  /// Like `DetectorInfo::circles`. Known from the start.
  virtual bool gives_circles() const { return true; }

  /// Call after the last frame. \throws for errors up to then.
  virtual void finish() {}

  /// Counts of the faults in its input so far, if it checks that.
  virtual Diagnostics diagnostics() const { return {}; }

  /// Human-readable remarks after the last frame, a line each.
  virtual std::vector<std::string> remarks() const { return {}; }
};

/// The simulator's camera as intrinsics for the filter and all detectors.
Intrinsics intrinsics(const sim::Pinhole& camera);

/// Gaps that an earlier run has looked at. A gap that the run did not ask for gets the answer of
/// the gap that overlaps it most.
class StoredGaps : public GapView {
 public:
  void show(const std::vector<GapSeen>& gaps) { gaps_ = &gaps; }
  void begin(const EgoMotion&) override {}
  std::optional<double> evidence(const Gap& gap) override;

 private:
  const std::vector<GapSeen>* gaps_ = nullptr;
};

/// The LCS filter. It uses corners, their signatures if any, and ego-motion; of the image only the
/// gaps below circles.
class LcsDetector : public Detector {
 public:
  LcsDetector(const Intrinsics& camera, const AnyParameters& parameters)
      : filter_(camera, parameters), picture_(camera) {}
  const FrameResult& step(const DetectorInput& input) override {
    GapView* view = nullptr;
    if (!input.grey.empty()) {
      picture_.show(input.grey);
      view = &picture_;
    } else if (input.gaps != nullptr) {
      stored_.show(*input.gaps);
      view = &stored_;
    }
    if (input.signatures.empty()) return filter_.step(input.corners_px, input.motion, view);
    return filter_.step(input.corners_px, input.signatures, input.motion, view);
  }
  bool wants_signatures() const override { return true; }
  Diagnostics diagnostics() const override { return filter_.diagnostics(); }
  const AnyFilter& filter() const { return filter_; }

 private:
  AnyFilter filter_;
  GapPicture picture_;
  StoredGaps stored_;
};

/// The scenario's preset, modified by its settings.
/// \throws input::Error at the line of an unknown preset or key, or an invalid value.
AnyParameters filter_parameters(const scenario::Scenario& scenario);

}  // namespace lcs::bench
