/// \file
/// Results of whole recordings, which the product computes frame by frame.
#pragma once

#include <vector>

#include "tools/recording/detections.h"
#include "tools/recording/warnings.h"
#include "tools/scoring/events.h"
#include "tools/scoring/figures_file.h"
#include "tools/scoring/score_rebels.h"

namespace lcs::scoring {

inline std::vector<recording::Warned> warnings_of(const recording::Recording& recording) {
  recording::WarningWatch watch(recording.truth);
  for (const recording::FrameRecord& frame : recording.frames) watch.add(frame);
  return watch.warned(recording.warnings);
}

inline std::vector<RebelCounts> score_frames(const recording::Recording& recording) {
  Scorer scorer(recording);
  std::vector<RebelCounts> counts;
  for (const recording::FrameRecord& frame : recording.frames)
    counts.push_back(scorer.add(frame).rebels);
  return counts;
}

inline std::vector<ScoredEvent> all_events(const recording::Recording& recording) {
  Scorer scorer(recording);
  EventFinder finder(recording);
  for (const recording::FrameRecord& frame : recording.frames) {
    finder.add(frame, scorer.add(frame).outcomes);
  }
  return finder.events(scorer.detections());
}

/// Events of rebels and circles. \param most of each family.
inline std::vector<ScoredEvent> find_events(const recording::Recording& recording,
                                            std::size_t most = kMostEvents) {
  std::vector<ScoredEvent> events = all_events(recording);
  std::erase_if(events, [](const ScoredEvent& event) {
    return family_of(event.kind) == EventFamily::squares;
  });
  keep_worst(events, most);
  return events;
}

inline std::vector<ScoredEvent> find_square_events(const recording::Recording& recording) {
  std::vector<ScoredEvent> events = all_events(recording);
  std::erase_if(events, [](const ScoredEvent& event) {
    return family_of(event.kind) != EventFamily::squares;
  });
  keep_worst(events, kMostEvents);
  return events;
}

inline void write_frames(const std::filesystem::path& path, const recording::Recording& recording) {
  FramesWriter writer(path, recording);
  Scorer scorer(recording);
  for (const recording::FrameRecord& frame : recording.frames)
    writer.write(frame, scorer.add(frame).rebels);
  writer.close();
}

inline void write_detections(const std::filesystem::path& csv,
                             const recording::Recording& recording) {
  recording::DetectionsWriter writer(csv, recording);
  for (const recording::FrameRecord& frame : recording.frames) writer.write(frame);
  writer.close();
}

inline void read_times(const std::filesystem::path& path, recording::Recording& recording) {
  TimesReader times(path);
  for (recording::FrameRecord& frame : recording.frames) times.read(frame);
  times.finish();
}

}  // namespace lcs::scoring
