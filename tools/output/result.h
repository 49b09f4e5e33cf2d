/// \file
/// Writes the files of a run frame by frame; the result is complete or absent.
#pragma once

#include <array>
#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "tools/files/output.h"
#include "tools/files/provenance.h"
#include "tools/output/frame_pictures.h"
#include "tools/output/panels.h"
#include "tools/output/video.h"
#include "tools/recording/recording.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/events.h"
#include "tools/scoring/figures_file.h"
#include "tools/scoring/scoring.h"

namespace lcs::output {

/// A frame's four panels, with boxes of the truth beneath the layers, and the found, missed and
/// false items of that frame alone. Unlike for recall, a rebel counts as missed from its first
/// frame on. \param run with the names of scenario and objects, and whether their truth is known.
/// \param image of the frame, BGR. \throws std::invalid_argument like `PanelSheet::draw`.
cv::Mat3b painted(const PanelSheet& sheet, const recording::RunInfo& run,
                  const recording::FrameRecord& frame, const cv::Mat3b& image);

/// All files that the folder of a run may contain.
files::ResultNames result_files();

/// How much of a run is kept.
enum class Keep {
  figures,  ///< metrics and warnings
  events,   ///< also the rows of all frames, and events if there are any
  all,      ///< also layers, truth and pictures, from which `--recorded` runs again
};

/// The words of `--keep`, in the order of `Keep`.
inline constexpr std::array<std::string_view, 3> kKeepWords{"figures", "events", "all"};
constexpr std::string_view word_of(Keep keep) {
  return kKeepWords.at(static_cast<std::size_t>(keep));
}

/// \throws std::invalid_argument for another word.
Keep keep_of(const std::string& word);

/// Optional contents of a result.
struct ResultOptions {
  Keep keep = Keep::all;
  bool compressed = false;                        ///< layers and truth
  bool is_truth_there = false;                    ///< `copy_truth` or `share_truth` provides it
  std::optional<double> video_frames_per_second;  ///< absent: no video
  bool events = false;  ///< write the run's errors with pictures, and all pictures
  /// Pictures of these frames from an earlier run; `events` then stores none.
  const FramePictures* kept = nullptr;
  /// Called with each frame of the video, until it returns false.
  std::function<bool(const cv::Mat3b& sheet)> show = {};
  /// Writes additional files to the folder, after all others and before the commit.
  std::function<void(const std::filesystem::path& folder, const scoring::Metrics& metrics)>
      add_page = {};
};

/// The first frames of a run with events stay in memory, about 0.2 MB each, until their events are
/// painted. Later ones are read back.
inline constexpr std::size_t kMostHeld = 200;

class Result {
 public:
  /// \param run whose frames will be added.
  /// \throws OutputError for a target that cannot be written or contains other files.
  Result(const std::filesystem::path& target, const recording::RunInfo& run, cv::Size image_px,
         const ResultOptions& options);

  /// Scores the frame and writes its rows. Of a frame beyond `kMostHeld`, only numbers are kept.
  /// \param image may be empty if no video is made or shown.
  /// \throws OutputError; std::invalid_argument as `Scorer::add`.
  void add(const recording::FrameRecord& frame, const cv::Mat3b& image);

  /// Writes the files that depend on all frames. The folder appears when the output is committed.
  /// \param world the simulation's warnings; absent without a simulation. \throws OutputError
  scoring::Metrics finish(const std::optional<sim::Warnings>& world);

  int frames() const { return scorer_.frames(); }
  /// All warnings of the run, after `finish`.
  const std::vector<recording::Warned>& warned() const { return warned_; }

  /// Copies the truth of the same frames from the folder of an earlier run. Before `finish`, if
  /// there are events. \throws as `copy_bytes`
  void copy_truth(const std::filesystem::path& folder);

  /// After `finish` of both: takes the truth of the same frames from `other`, as one file for both.
  /// On another file system as a copy. \throws as `copy_bytes`
  void share_truth(const Result& other);

  files::Output& output() { return folder_; }

 private:
  void write_events_file();

  files::Output folder_;
  ResultOptions options_;
  cv::Size image_px_;
  scoring::Scorer scorer_;
  std::vector<recording::Warned> warned_;
  std::optional<scoring::FramesWriter> rows_;
  std::optional<recording::RecordingWriter> writer_;
  recording::RunInfo run_;
  PanelSheet sheet_;
  std::optional<Video> video_;
  std::optional<scoring::EventFinder> events_;
  std::vector<recording::FrameRecord> held_;  ///< the first frames, if there are events
  std::optional<PicturesWriter> own_pictures_;
};

}  // namespace lcs::output
