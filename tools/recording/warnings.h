/// \file
/// Warnings that come with the figures of a run: those of the simulation (`sim/warnings.h`),
/// pictures with hardly a corner, and in recordings an implausible motion (`motion_warnings.h`).
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "sim/warnings.h"
#include "tools/recording/recording.h"

namespace lcs::bench {

inline constexpr const char* kWarningsFile = "warnings.json";

/// Fewer corners in a frame are too few: a match needs other corners round it to support it.
inline constexpr int kFewCorners = 10;

struct Warned {
  std::string word;                   ///< "warnings.WORD" is the metric
  std::optional<std::int64_t> count;  ///< none: not checked in this run
  std::string text;                   ///< the first time, in words, and what to do; empty for none
};

/// One for each word, in a fixed order.
std::vector<Warned> warnings_of(const Recording& recording);

/// A line for people for each that happened.
std::vector<std::string> lines_of(const std::vector<Warned>& warnings);

/// All of them, by word. \throws OutputError
void write_warnings(const std::filesystem::path& path, const std::vector<Warned>& warnings);

/// What was written there. \throws scenario::Error naming file and what is wrong with it.
std::vector<Warned> read_warnings(const std::filesystem::path& path);

/// The warnings that the simulation gave in a run; none where the run's folder has no such file.
/// \throws as `read_warnings`.
std::optional<sim::Warnings> world_warnings(const std::filesystem::path& folder);

}  // namespace lcs::bench
