/// \file
/// Writes scenarios as sequences of pictures and truth for other tools.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/app/caller.h"
#include "tools/app/option.h"
#include "tools/app/world.h"
#include "tools/sequence/generator.h"

namespace lcs::app {

struct GenerateRequest {
  std::vector<std::string> paths;    ///< one scenario file; with `suite`: files and folders
  bool suite = false;                ///< one sequence for each scenario and seed
  WorldsChoice worlds;               ///< a sequence for each world, in place of `paths`
  std::string out;                   ///< folder; "" is data/<scenario's name>, data with `suite`
  std::vector<std::string> formats;  ///< empty: the usual ones
  bool add = false;                  ///< adds the formats to a finished sequence in `out`
  std::optional<std::uint64_t> seed;
  std::vector<std::string> sets;     ///< "key=value"
  int frames = 0;                    ///< 0: all frames of the scenario
  int jobs = 1;                      ///< concurrent processes
  std::string shard;                 ///< "i/n": only this part; "" is all
  std::optional<std::string> group;  ///< with `suite`: as in `SuiteRequest`
  std::string filter;                ///< as in `SuiteRequest`
  int seeds = 1;                     ///< per scenario, with `suite`

  /// Whether `generate_suite` makes it.
  bool is_of_many() const { return suite || !worlds.split.empty(); }
};

Options options_of(GenerateRequest& request);

/// A sequence, or a part of one.
struct Generated {
  std::filesystem::path folder;
  sequence::FrameRange range;      ///< of the part
  std::vector<std::string> notes;  ///< remarks of the writers on their files
  enum class State { whole, part, complete_before } state = State::whole;
  scenario::Scenario scenario = {};
};

/// Makes one sequence.
/// \throws input::Error, files::OutputError, sequence::TruthError, sim::PhysicsError,
///   std::exception. Complete frames are kept, and the same request resumes after them.
Generated generate(const GenerateRequest& request, Caller& caller);

/// The sequences of a suite.
struct SequencesMade {
  std::vector<std::filesystem::path> folders;
  std::vector<std::string> errors;  ///< of scenarios and sequences that could not be made
};

/// Makes the sequences of a suite or of worlds, each in a process of its own. Only the worlds
/// of the shard are drawn. \throws as `generate`.
SequencesMade generate_suite(const GenerateRequest& request, Caller& caller);

}  // namespace lcs::app
