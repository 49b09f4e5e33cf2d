/// \file
/// Feeds the frames of a recording, instead of simulated ones, to the bench's loop.
#pragma once

#include <cstddef>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/camera/rectifier.h"
#include "tools/bench/bench.h"
#include "tools/replay/motion_check.h"
#include "tools/replay/recorded.h"

namespace lcs::replay {

class Playback : public bench::FrameSource {
 public:
  /// Of the camera, between frames of which the filter knows corners again.
  static constexpr double kMostPeriods = 4;

  /// Reads everything except the pictures, of which it decodes only the first one.
  /// \throws input::Error for unreadable or missing input, std::runtime_error.
  explicit Playback(const scenario::Scenario& asked);

  /// The given scenario, completed by the recording's settings of filter and corners, with the
  /// actual number of frames and frame rate.
  const scenario::Scenario& scenario() const { return scenario_; }
  const sim::Pinhole& camera() const { return rectifier_->camera(); }

  /// The facts of a run of the scenario.
  recording::RunInfo info() const;

  bool next(recording::FrameRecord& frame, cv::Mat3b& image) override;
  std::span<const sim::Event> events() const override { return events_; }
  bool straighten(std::vector<Eigen::Vector2f>& corners_px, cv::Mat& picture) const override;
  void label(recording::FrameRecord& frame) override;
  Diagnostics diagnostics() const override;

  /// Number of unusable pictures so far.
  std::size_t skipped() const { return next_ - static_cast<std::size_t>(index_); }
  /// The faults and missing inputs so far: one readable line each.
  std::vector<std::string> remarks() const;

 private:
  void take_settings();
  void look_at_first_picture();
  void read_mask();
  void read_labels();
  void require_events() const;
  void require_right_motion() const;
  void label_by_truth(const RecordedFrame& recorded, recording::FrameRecord& frame);

  scenario::Scenario scenario_;
  Recorded recorded_;
  PictureReader pictures_;
  std::optional<sim::Rectifier> rectifier_;
  MotionCheck motion_check_;
  recording::Truth truth_;        ///< of corners
  int corners_ = 0, untold_ = 0;  ///< seen so far, and those without truth
  recording::Labels labels_;      ///< of moving objects, if present
  cv::Mat1b mask_;                ///< empty, or non-zero at ignored pixels
  std::size_t next_ = 0;          ///< of the recorded frames
  int index_ = 0;                 ///< of the next frame
  double longest_s_ = 0;          ///< between frames of which the filter knows corners again
  std::size_t events_end_ = 0;    ///< of those that frames had so far
  std::span<const sim::Event> events_;
  bool grounded_ = false;  ///< the last frame has a ground
};

}  // namespace lcs::replay
