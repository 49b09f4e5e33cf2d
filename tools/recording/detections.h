/// \file
/// The verdicts of any detector on the corners of a sequence, and the boxes that it finds, in a CSV
/// file. `tools/recording/DETECTIONS.md` describes the format.
#pragma once

#include <filesystem>

#include "tools/files/output_file.h"
#include "tools/recording/frame_detections.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

struct Detections {
  /// The sequence with the detector's verdicts and boxes in place of what it had; no times.
  Recording recording;
  VerdictCounts counts;
};

/// \param sequence whose corners and truth the detections are of; its camera is what they are
///   checked against.
/// \throws scenario::Error by file and line.
Detections read_detections(const std::filesystem::path& csv, const Recording& sequence);

inline constexpr const char* kDetectionsHeader = "frame,type";

/// Writes a recording's verdicts and boxes in the same format. Read again, they give the same
/// figures of rebels and squares to the last bit. \throws OutputError
void write_detections(const std::filesystem::path& csv, const Recording& recording);

}  // namespace lcs::bench
