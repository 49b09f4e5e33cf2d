/// \file
/// A scenario written to a folder as a sequence: simulated, checked and written frame by frame.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "sim/warnings.h"
#include "tools/sequence/journal.h"

namespace lcs::sequence {

/// Frames [first, last).
struct FrameRange {
  int first = 0, last = 0;
};

/// Part i of n, from 1, of `count` things in a row.
/// \throws std::invalid_argument unless 1 <= i <= n.
FrameRange part_of(int count, int i, int n);

struct GenerateOptions {
  std::vector<std::string> formats;  ///< by name
  std::vector<std::string> sets;     ///< that the scenario was loaded with
  std::string program;               ///< this one's version and commit
};

/// What the bytes of a sequence depend on, as a JSON object. Starts GL to ask for its version.
std::string plan_of(const scenario::Scenario& scenario, const GenerateOptions& options);

/// Renders and writes those frames of a range that are not whole yet.
/// \param on_frame called with how many frames of the range are whole; what it throws ends the
///   generation between two frames.
/// \return what was wrong in the world until the last frame that was missing; nothing if none was.
/// \throws TruthError, sim::PhysicsError, bench::OutputError
sim::Warnings generate_frames(const scenario::Scenario& scenario, const GenerateOptions& options,
                     const Journal& journal, FrameRange range,
                     const std::function<void(int)>& on_frame);

/// Writes what is made of all frames, the manifest last, and ends the journal.
/// \return lines for people: what the sequence holds, and which of its files are empty.
/// \throws bench::OutputError; std::runtime_error if a frame is not whole.
std::vector<std::string> finish_sequence(const scenario::Scenario& scenario,
                                         const GenerateOptions& options, const std::string& plan,
                                         Journal& journal);

}  // namespace lcs::sequence
