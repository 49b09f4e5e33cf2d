/// \file
/// The frames of a recording in place of a simulation's, for the bench's own loop.
#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/bench/bench.h"
#include "tools/replay/picture_stream.h"
#include "tools/replay/recorded.h"
#include "tools/replay/rectifier.h"

namespace lcs::replay {

class Playback : public bench::FrameSource {
 public:
  /// Reads all but the pictures, of which it looks at the first one.
  /// \throws scenario::Error for what cannot be read or is not known, std::runtime_error.
  explicit Playback(const scenario::Scenario& asked);

  /// As it was asked for, with what the recording says of the filter and the corners where that
  /// does not, and the frames and their rate as they are.
  const scenario::Scenario& scenario() const { return scenario_; }
  const sim::Pinhole& camera() const { return rectifier_->camera(); }

  /// A recording of the scenario without frames yet.
  bench::Recording begin() const;

  bool next(bench::FrameRecord& frame, cv::Mat3b& image) override;
  bool straighten(std::vector<Eigen::Vector2f>& corners_px, cv::Mat3b& image) const override;
  void label(bench::FrameRecord& frame) override;
  Diagnostics diagnostics() const override;

  /// Pictures that could not be used so far.
  std::size_t skipped() const { return next_ - static_cast<std::size_t>(index_); }
  /// What was not as it should be so far, and what is not known: a line for people each.
  std::vector<std::string> told() const;

 private:
  void take_settings();
  void look_at_first_picture();
  void read_mask();
  void label_by_truth(const RecordedFrame& recorded, bench::FrameRecord& frame);

  scenario::Scenario scenario_;
  Recorded recorded_;
  PictureStream pictures_;
  std::optional<Rectifier> rectifier_;
  bench::Truth truth_;     ///< of corners
  std::map<std::string, const bench::FrameRecord*> truth_of_;  ///< by picture, where all is known
  int corners_ = 0, untold_ = 0;  ///< that were met, and those of which no truth is known
  bench::Labels labels_;   ///< of movers, where there are some
  cv::Mat1b mask_;         ///< empty, or not 0 where nobody looks
  std::size_t next_ = 0;   ///< of the recorded frames
  int index_ = 0;          ///< of the frame that comes next
  bool grounded_ = false;  ///< the last frame has a ground
};

}  // namespace lcs::replay
