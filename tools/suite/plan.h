/// \file
/// Which runs a suite consists of: the scenarios that were asked for, at each point that they
/// sweep.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"
#include "tools/suite/suite_result.h"

namespace lcs::suite {

struct PlanOptions {
  std::vector<std::filesystem::path> paths;  ///< files and folders; none: the project's scenarios
  /// Only scenarios of this group; "all" is any. None: any, but `short` of the project's own
  /// folder.
  std::optional<std::string> group;
  std::string filter;             ///< regular expression, found anywhere in a name; "" is any
  std::vector<std::string> sets;  ///< "key=value", for all of them
  int seeds = 3;                  ///< >= 1
};

/// One scenario, at one point of its sweep.
struct PlannedScenario {
  std::string name;               ///< unique, fit for a folder
  std::filesystem::path file;     ///< as a child process is to be given it
  std::vector<std::string> sets;  ///< those of all, then those of the point
  std::vector<std::pair<std::string, std::string>> point;  ///< swept keys and values, if any
  std::optional<scenario::Scenario> scenario;  ///< none: `error` says what is wrong with it
  std::string error;
  std::vector<std::uint64_t> seeds;  ///< one, 0, for an error
};

/// The scenarios to run, by file and then in the order of the sweep. A scenario that is broken is
/// part of the plan, whatever its group.
/// \throws std::runtime_error for paths that are not there or hold no scenario, a filter that is no
///   regular expression, two scenarios of one name, and when nothing is left.
std::vector<PlannedScenario> plan(const PlanOptions& options);

/// How much work a run is, in frames times pixels; guessed for a recording.
double work(const scenario::Scenario& scenario);

}  // namespace lcs::suite
