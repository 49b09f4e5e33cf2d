/// \file
/// The runs of a suite: the requested scenarios at each point of their sweeps; and the regular
/// expressions from the user that choose among names.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <regex>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "scenarios/scenario.h"

namespace lcs::suite {

struct PlanOptions {
  std::vector<std::filesystem::path> paths;  ///< files and folders; empty: the project's own
  /// Only scenarios of this group; "all": any. Absent: any, but `short` for the project's own
  /// folder.
  std::optional<std::string> group;
  std::string filter = {};        ///< regular expression that a part of the name matches; "": any
  std::vector<std::string> sets;  ///< "key=value", for all scenarios
  int seeds = 3;                  ///< >= 1
};

/// One scenario, at one point of its sweep.
struct PlannedScenario {
  std::string name;                    ///< unique; usable as a folder name
  std::filesystem::path file;          ///< the path for the child process
  std::vector<std::string> sets = {};  ///< the sets of `PlanOptions`, then the point's
  std::vector<std::pair<std::string, std::string>> point = {};  ///< swept keys and values, if any
  std::optional<scenario::Scenario> scenario = {};              ///< absent: `error` has the reason
  std::string error;
  std::vector<std::uint64_t> seeds;  ///< a single 0 for an error
};

/// The scenarios to run, by file and then in the order of the sweep. A broken scenario is part of
/// the plan regardless of its group.
/// \throws std::runtime_error for paths that are missing or hold no scenario, an invalid filter,
///   two files with the same scenario name, and an empty plan.
std::vector<PlannedScenario> plan(const PlanOptions& options);

/// Removes all other runs from a plan, and scenarios without any. \param runs names and seeds.
void keep_runs(std::vector<PlannedScenario>& plan,
               const std::set<std::pair<std::string, std::uint64_t>>& runs);

/// The estimated work of a run, in frames times pixels; a guess for a recording.
double work(const scenario::Scenario& scenario);

/// An ECMAScript regular expression without back-references, so that matching time is bounded.
class Pattern {
 public:
  /// \param option the option's name, such as "--filter". \param example a valid pattern.
  /// \throws std::runtime_error for an invalid expression or one with more than 1000 parts.
  Pattern(const std::string& text, std::string_view option, std::string_view example);

  /// Whether the pattern matches anywhere in the name's first 255 bytes.
  bool is_in(std::string_view name) const;

 private:
  std::regex regex_;
};

}  // namespace lcs::suite
