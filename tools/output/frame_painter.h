/// \file
/// Pictures of a run: each frame's four panels, with boxes of the truth beneath the layers, and the
/// found, missed and false items of that frame alone. Unlike for recall, a rebel counts as missed
/// from its first frame on.
#pragma once

#include <map>
#include <opencv2/core.hpp>
#include <string>

#include "tools/output/panels.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

class FramePainter {
 public:
  /// \param image_px size of the camera's image. \param run with the names of scenario and objects,
  ///   and whether their truth is known.
  FramePainter(cv::Size image_px, const RunInfo& run);

  cv::Size size_px() const { return sheet_.size_px(); }

  /// \param image of the frame, BGR. \throws std::invalid_argument like `PanelSheet::draw`.
  cv::Mat3b paint(const FrameRecord& frame, const cv::Mat3b& image) const;

 private:
  PanelSheet sheet_;
  std::string scenario_;
  bool is_truth_known_;
  std::map<int, std::string> names_;  ///< by object id
};

}  // namespace lcs::bench
