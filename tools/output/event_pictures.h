/// \file
/// Pictures of events: a crop round each error, with corners marked by their outcome.
#pragma once

#include <set>
#include <vector>

#include "tools/output/frame_pictures.h"
#include "tools/scoring/events.h"

namespace lcs::output {

inline constexpr int kEventPictureWidth_px = 256, kEventPictureHeight_px = 192;

/// The numbers of the frames that the events show, each once.
std::set<int> frames_shown(const std::vector<scoring::ScoredEvent>& events);

/// Paints the pictures of all views of a frame. \param outcomes of its corners. \param pictures
/// of the run, whose frames are numbered from 0.
void paint_views(const recording::FrameRecord& frame,
                 const std::vector<scoring::CornerOutcome>& outcomes, const FramePictures& pictures,
                 std::vector<scoring::ScoredEvent>& events);

}  // namespace lcs::output
