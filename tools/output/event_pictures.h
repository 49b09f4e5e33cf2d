/// \file
/// Pictures of events: a crop round what went wrong, with every corner marked by how it counts.
#pragma once

#include <vector>

#include "tools/output/frame_pictures.h"
#include "tools/scoring/events.h"

namespace lcs::bench {

inline constexpr int kEventPictureWidth_px = 256, kEventPictureHeight_px = 192;

/// Makes the picture of every view. \param pictures of each of the recording's frames.
void paint_events(const Recording& recording, const FramePictures& pictures,
                  std::vector<Event>& events);

}  // namespace lcs::bench
