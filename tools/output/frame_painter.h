/// \file
/// Pictures of a run: each frame's four panels, with the truth's boxes beneath the layers.
#pragma once

#include <opencv2/core.hpp>

#include "filter/draw/panels.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

class FramePainter {
 public:
  /// \param image_px size of the camera's image.
  explicit FramePainter(cv::Size image_px) : sheet_(image_px) {}

  cv::Size size_px() const { return sheet_.size_px(); }

  /// \param image of the frame, BGR. \throws std::invalid_argument as `PanelSheet::draw`.
  cv::Mat3b paint(const FrameRecord& frame, const cv::Mat3b& image) const;

 private:
  PanelSheet sheet_;
};

}  // namespace lcs::bench
