/// \file
/// Results of whole recordings, which the product computes frame by frame.
#pragma once

#include <vector>

#include "tools/recording/detections.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/events.h"
#include "tools/scoring/figures_file.h"
#include "tools/scoring/score_rebels.h"

namespace lcs::bench {

inline std::vector<Warned> warnings_of(const Recording& recording) {
  WarningWatch watch(recording.truth);
  for (const FrameRecord& frame : recording.frames) watch.add(frame);
  return watch.warned(recording.warnings);
}

inline std::vector<RebelCounts> score_frames(const Recording& recording) {
  Scorer scorer(recording);
  std::vector<RebelCounts> counts;
  for (const FrameRecord& frame : recording.frames) counts.push_back(scorer.add(frame).rebels);
  return counts;
}

inline std::vector<Event> all_events(const Recording& recording) {
  Scorer scorer(recording);
  EventFinder finder(recording);
  for (const FrameRecord& frame : recording.frames) {
    finder.add(frame, scorer.add(frame).outcomes);
  }
  return finder.events(scorer.detections());
}

/// Events of rebels and circles. \param most of each family.
inline std::vector<Event> find_events(const Recording& recording, std::size_t most = kMostEvents) {
  std::vector<Event> events = all_events(recording);
  std::erase_if(events,
                [](const Event& event) { return family_of(event.kind) == EventFamily::squares; });
  keep_worst(events, most);
  return events;
}

inline std::vector<Event> find_square_events(const Recording& recording) {
  std::vector<Event> events = all_events(recording);
  std::erase_if(events,
                [](const Event& event) { return family_of(event.kind) != EventFamily::squares; });
  keep_worst(events, kMostEvents);
  return events;
}

inline void write_frames(const std::filesystem::path& path, const Recording& recording) {
  FramesWriter writer(path, recording);
  Scorer scorer(recording);
  for (const FrameRecord& frame : recording.frames) writer.write(frame, scorer.add(frame).rebels);
  writer.close();
}

inline void write_detections(const std::filesystem::path& csv, const Recording& recording) {
  DetectionsWriter writer(csv, recording);
  for (const FrameRecord& frame : recording.frames) writer.write(frame);
  writer.close();
}

inline void read_times(const std::filesystem::path& path, Recording& recording) {
  TimesReader times(path);
  for (FrameRecord& frame : recording.frames) times.read(frame);
  times.finish();
}

}  // namespace lcs::bench
