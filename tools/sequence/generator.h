/// \file
/// Writes a scenario as a sequence into a folder: simulates, checks and writes frame by frame.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/world/warnings.h"
#include "tools/sequence/sequence_folder.h"

namespace lcs::sequence {

/// Frames [first, last).
struct FrameRange {
  int first = 0, last = 0;
};

/// Part i (from 1) of `count` consecutive items that are split into n parts.
/// \throws std::invalid_argument unless 1 <= i <= n.
FrameRange part_of(int count, int i, int n);

struct GenerateOptions {
  std::vector<std::string> formats;  ///< by name
  std::vector<std::string> sets;     ///< overrides that the scenario was loaded with
  files::Json program;               ///< facts: version and commit of this program
};

/// The settings and versions that determine the bytes of a sequence, beside the files that are
/// read. Starts GL for its version.
files::Json facts_of(const scenario::Scenario& scenario, const GenerateOptions& options);

/// Renders and writes the incomplete frames of a range.
/// \param on_frame called with the number of complete frames of the range; an exception from it
///   ends the generation between two frames.
/// \return the simulation's warnings up to the last missing frame; empty if none was missing.
/// \throws TruthError, sim::PhysicsError, files::OutputError
sim::Warnings generate_frames(const scenario::Scenario& scenario, const GenerateOptions& options,
                              SequenceFolder& folder, FrameRange range,
                              const std::function<void(int)>& on_frame);

/// Writes the files that need all frames, and moves the sequence to its target.
/// \return readable lines: the sequence's contents, and its empty files.
/// \throws files::OutputError; std::runtime_error if a frame is incomplete.
std::vector<std::string> finish_sequence(const scenario::Scenario& scenario,
                                         const GenerateOptions& options, SequenceFolder& folder);

}  // namespace lcs::sequence
