/// \file
/// A CSV file of any detector's verdicts and boxes for the frames of a sequence.
/// `tools/recording/DETECTIONS.md` describes the format.
#pragma once

#include <filesystem>
#include <optional>

#include "tools/files/output_file.h"
#include "tools/recording/frame_detections.h"
#include "tools/recording/recording.h"

namespace lcs::recording {

struct Detections {
  /// The sequence with the file's verdicts and boxes instead of its own; without times.
  Recording recording;
  VerdictCounts counts;
};

/// \param sequence provides corners and truth; its camera is used to check the detections.
/// \throws input::Error with file and line.
Detections read_detections(const std::filesystem::path& csv, Recording sequence);

/// Writes a run's verdicts and boxes in the same format, frame by frame. Reading them back
/// reproduces the rebel and square metrics to the last bit.
class DetectionsWriter {
 public:
  /// \throws OutputError
  DetectionsWriter(const std::filesystem::path& csv, const RunInfo& run);
  /// \throws OutputError
  void write(const FrameRecord& frame);
  /// \throws OutputError
  void close() { file_.close(); }

 private:
  files::OutputFile file_;
  std::optional<Intrinsics> camera_;
  bool states_circles_;  ///< before the next frame, as it may have none
};

}  // namespace lcs::recording
