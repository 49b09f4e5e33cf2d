/// \file
/// Pictures of events: a crop round each error, with corners marked by their outcome.
#pragma once

#include <set>
#include <vector>

#include "tools/output/frame_pictures.h"
#include "tools/scoring/events.h"

namespace lcs::bench {

inline constexpr int kEventPictureWidth_px = 256, kEventPictureHeight_px = 192;

/// The numbers of the frames that the events show, each once.
std::set<int> frames_shown(const std::vector<Event>& events);

/// Paints the pictures of all views of a frame. \param outcomes of its corners. \param pictures
/// of the run, whose frames are numbered from 0.
void paint_views(const FrameRecord& frame, const std::vector<CornerOutcome>& outcomes,
                 const FramePictures& pictures, std::vector<Event>& events);

}  // namespace lcs::bench
