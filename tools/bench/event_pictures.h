/// \file
/// Pictures of events: cut out round what went wrong, with every corner marked by what it counts
/// as.
#pragma once

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "tools/bench/events.h"

namespace lcs::bench {

/// The images of a run, compressed, until the events are known at its end. Images wider than 640 px
/// are kept at that width: some 40 kB a frame.
class FramePictures {
 public:
  /// \param image of the next frame of the recording, BGR.
  void add(const cv::Mat3b& image);

  /// \param scale set to pixels of the picture for one of the image.
  cv::Mat3b at(std::size_t position, double& scale) const;
  std::size_t size() const { return jpegs_.size(); }

 private:
  std::vector<std::vector<unsigned char>> jpegs_;
  double scale_ = 1;
};

inline constexpr int kEventPictureWidth_px = 256, kEventPictureHeight_px = 192;

/// Makes the picture of every view. \param pictures of each of the recording's frames.
void paint_events(const Recording& recording, const FramePictures& pictures,
                  std::vector<Event>& events);

}  // namespace lcs::bench
