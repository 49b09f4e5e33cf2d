/// \file
/// Detections read from a CSV file (tools/recording/DETECTIONS.md), frame by frame.
#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

#include "tools/bench/detector.h"
#include "tools/recording/detections.h"

namespace lcs::comparators {

class StoredDetections : public bench::Detector {
 public:
  /// \param sequence with the frames that will be processed, in order.
  /// \throws input::Error naming file and line.
  StoredDetections(const std::filesystem::path& csv, bench::Recording sequence)
      : said_(bench::read_detections(csv, std::move(sequence))) {}

  const FrameResult& step(const bench::DetectorInput&) override {
    bench::FrameRecord& frame = said_.recording.frames.at(next_++);
    result_.verdicts = std::move(frame.verdicts);
    result_.layers = std::move(frame.layers);
    masks_ = std::move(frame.masks);
    return result_;
  }
  double bench::FrameTimes::*step_time() const override { return nullptr; }
  bool gives_circles() const override { return said_.recording.detector.circles; }
  const bench::SquareMasks& masks() const override { return masks_; }
  std::vector<std::string> told() const override { return bench::lines_of(said_.counts); }

 private:
  bench::Detections said_;
  std::size_t next_ = 0;
  FrameResult result_;
  bench::SquareMasks masks_;
};

}  // namespace lcs::comparators
