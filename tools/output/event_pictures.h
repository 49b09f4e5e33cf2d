/// \file
/// Pictures of events: a crop round each error, with corners marked by their outcome.
#pragma once

#include <vector>

#include "tools/output/frame_pictures.h"
#include "tools/scoring/events.h"

namespace lcs::bench {

inline constexpr int kEventPictureWidth_px = 256, kEventPictureHeight_px = 192;

/// Paints the picture of each view. \param pictures one for each frame of the recording.
void paint_events(const Recording& recording, const FramePictures& pictures,
                  std::vector<Event>& events);

}  // namespace lcs::bench
