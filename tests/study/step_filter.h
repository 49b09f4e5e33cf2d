/// \file
/// A filter between the paper's and the default one: it has some rules of the default filter in
/// place of the paper's. With none it gives the bits of the preset `lab`, with all those of
/// `default`. Both filters' parts keep the numbers of their own presets.
#pragma once

#include <memory>

#include "tests/study/rules.h"
#include "tools/bench/detector.h"

namespace lcs::study {

class StepFilter {
 public:
  StepFilter(const Intrinsics& camera, const Rules& rules);
  ~StepFilter();

  /// Like `lcs::Filter::step`. Only the rule of radial movers uses `view`.
  const FrameResult& step(std::span<const Eigen::Vector2f> corners_px,
                          std::span<const Signature> signatures, const EgoMotion& told,
                          GapView* view);

 private:
  struct Impl;
  std::unique_ptr<Impl> impl_;
};

/// The same as a detector of a run.
class StepDetector : public bench::Detector {
 public:
  StepDetector(const Intrinsics& camera, const Rules& rules)
      : filter_(camera, rules), picture_(camera) {}

  const FrameResult& step(const bench::DetectorInput& input) override {
    GapView* view = nullptr;
    if (!input.grey.empty()) {
      picture_.show(input.grey);
      view = &picture_;
    } else if (input.gaps != nullptr) {
      stored_.show(*input.gaps);
      view = &stored_;
    }
    return filter_.step(input.corners_px, input.signatures, input.motion, view);
  }
  bool wants_signatures() const override { return true; }

 private:
  StepFilter filter_;
  GapPicture picture_;
  bench::StoredGaps stored_;
};

}  // namespace lcs::study
