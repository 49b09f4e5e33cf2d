/// \file
/// The files of a run, written frame by frame, whole or absent in the end.
#pragma once

#include <filesystem>
#include <functional>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/output.h"
#include "tools/output/frame_painter.h"
#include "tools/output/frame_pictures.h"
#include "tools/output/video.h"
#include "tools/recording/recording_io.h"
#include "tools/scoring/scoring.h"

namespace lcs::bench {

/// All files that a run's folder may hold.
ResultNames result_files();

/// What a result holds beside its figures.
struct ResultOptions {
  std::optional<double> video_frames_per_second;  ///< none: no video
  bool events = false;  ///< where the run went wrong, with pictures, and all pictures
  /// Pictures of the same frames from an earlier run, so that `events` needs to keep none.
  const FramePictures* kept = nullptr;
  /// Called with each frame of the video, until it returns false.
  std::function<bool(const cv::Mat3b& sheet)> show = {};
  /// Writes further files into the folder, when all others are in it and before it takes its place.
  std::function<void(const std::filesystem::path& folder, const Metrics& metrics)> add_page = {};
};

class Result {
 public:
  /// \param run whose frames will come.
  /// \throws OutputError for a target that cannot be written, or holds something else.
  Result(const std::filesystem::path& target, const Recording& run, cv::Size image_px,
         const ResultOptions& options);

  /// \param image may be empty where no video is made and nothing shown. \throws OutputError
  void add(const FrameRecord& frame, const cv::Mat3b& image);

  /// Scores the run, and writes what depends on all of it. The folder takes its place when the
  /// output is committed. \throws OutputError
  Metrics finish(const Recording& run);

  Output& output() { return folder_; }

 private:
  Output folder_;
  RecordingWriter writer_;
  FramePainter painter_;
  std::optional<Video> video_;
  decltype(ResultOptions::show) show_;
  bool events_;
  const FramePictures* kept_;
  decltype(ResultOptions::add_page) add_page_;
  FramePictures own_pictures_;
};

}  // namespace lcs::bench
