/// \file
/// The differences between two suites beyond the noise of their seeds.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/app/option.h"
#include "tools/recording/difference.h"
#include "tools/suite/comparison.h"
#include "tools/suite/suite_result.h"
#include "tools/suite/verdict.h"

namespace lcs::app {

struct CompareRequest {
  std::string before, after;   ///< suite.json, or its folder
  std::string metric;          ///< regular expression; "": every metric
  std::string markdown;        ///< folder for the summary of a merge request; "": none
  bool allow_missing = false;  ///< judges though runs of `before` are missing in `after`
  std::string pictures_at;     ///< address of its pictures; "": beside it
};

Options options_of(CompareRequest& request);

struct Compared {
  suite::SuiteResult before, after;
  suite::Comparison comparison = {};
  suite::SuiteVerdict verdict = {};
  std::vector<std::string> warnings = {};
};

/// \throws std::runtime_error if a suite cannot be read or the two have no scenario in common.
Compared compare(const CompareRequest& request);

/// The frames of a run in two results.
struct RunFrames {
  std::string name;                     ///< such as "crossing seed 1"; "" of two folders of runs
  std::filesystem::path before, after;  ///< folders
  recording::Difference difference;
};

struct ComparedFrames {
  std::vector<RunFrames> runs;       ///< those on both sides
  std::vector<std::string> missing;  ///< messages on runs of only one side
  bool is_different = false;
  std::string line;  ///< of the verdict
};

/// Compares the frames of two runs, or of the runs that two suites have in common.
/// \param request with the folders of runs or suites, and whether and where to write a summary: of
///   the first run that differs, its first frame, with the pictures of both sides.
/// \throws std::runtime_error if a file cannot be read, a run was made without frames (`--keep`),
///   or the two have no run in common. \throws OutputError
ComparedFrames compare_frames(const CompareRequest& request);

inline constexpr std::size_t kMostCorners = 20;  ///< that a text lists unless all are asked for

/// The first frame that differs, and a line for each of its corners that do, up to `most`.
std::string first_frame_text(const RunFrames& run, std::size_t most = kMostCorners);

}  // namespace lcs::app
