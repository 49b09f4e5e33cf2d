/// \file
/// Finds the corners of a frame by the scenario's section `corners`, and their signatures.
#pragma once

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>
#include <span>
#include <vector>

#include "filter/detect/event_corners.h"
#include "filter/detect/fast.h"
#include "scenarios/scenario.h"
#include "sim/events/event.h"

namespace lcs::bench {

/// Call it with each frame, in order: corners of events depend on all events before.
class CornerFinder {
 public:
  explicit CornerFinder(const scenario::Scenario& scenario)
      : fast_(scenario.fast_threshold),
        is_by_events_(scenario.corner_source == scenario::CornerSource::events) {}

  /// \param events since the frame before; not read if corners are those of pictures.
  /// \return in pixels of the picture.
  std::vector<Eigen::Vector2f> find(const cv::Mat1b& grey, std::span<const sim::Event> events);

  /// The picture that signatures are of, in place of the camera's: the surface of active events.
  /// Absent if it is the camera's.
  std::optional<cv::Mat1b> surface() const;

 private:
  FastDetector fast_;
  bool is_by_events_;
  std::optional<EventCorners> events_;  ///< from the first frame on
};

}  // namespace lcs::bench
