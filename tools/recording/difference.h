/// \file
/// The first frame in which two recordings differ, to show that a change of a detector changes
/// nothing, or where it begins to.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/recording/recording.h"

namespace lcs::recording {

/// What the detectors said of a corner, such as "rebel by rebel_edge, log odds 3.21"; "no corner"
/// where the frame has none there.
struct CornerDifference {
  Eigen::Vector2f place_px;
  std::string before, after;
};

struct FrameDifference {
  int frame = 0;          ///< index
  std::int64_t t_ns = 0;  ///< time of the frame in the first recording that has it
  /// All that differs, as named in layers.jsonl and truth.jsonl, up to three columns of a list:
  /// such as "corners/reason/verdict", "squares", "truth/objects"; "frame" if one recording ends.
  std::vector<std::string> parts;
  /// Those with another verdict first, each by row and column.
  std::vector<CornerDifference> corners;
  std::optional<FrameRecord> before, after;  ///< absent after the end of a recording
};

struct Difference {
  int frames = 0;     ///< of the longer recording
  int differing = 0;  ///< number of frames that differ in anything
  std::optional<FrameDifference> first;
};

/// Compares all that the recordings store: detections, input and truth of each frame.
/// \param before, after folders of runs. \throws std::runtime_error with file and line.
Difference difference_of(const std::filesystem::path& before, const std::filesystem::path& after);

}  // namespace lcs::recording
