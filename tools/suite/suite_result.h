/// \file
/// What a suite of runs came to: each scenario, with each of its seeds, and what it was asked to
/// reach. Written as `suite.json`; compared and shown from there alone.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "tools/recording/warnings.h"
#include "tools/scoring/criteria.h"
#include "tools/scoring/scoring.h"

namespace lcs::suite {

inline constexpr const char* kSuiteFile = "suite.json";

enum class Outcome {
  passed,
  failed,  ///< a required criterion is not met
  error,   ///< there are no figures: a broken scenario, scene, file or GL
};

struct RunResult {
  std::uint64_t seed = 0;
  Outcome outcome = Outcome::error;
  std::string command;     ///< that makes it again, as a shell takes it
  std::string error;       ///< the command's message, for an error
  bench::Metrics metrics;  ///< empty for an error
  std::vector<bench::JudgedCriterion> criteria;
  std::vector<bench::Warned> warnings;  ///< those that happened
  std::filesystem::path folder;         ///< of the run's own files, relative to the suite's
  double wall_s = 0;
};

/// What is known of a scenario that was drawn from a seed, a world (tools/worlds).
struct Drawn {
  std::string family;
  std::uint64_t again = 0;            ///< times that it could not be drawn, and was drawn again
  std::vector<std::string> features;  ///< what occurs in it
};

/// One scenario, or one point of the grid that it sweeps.
struct ScenarioResult {
  std::string name;  ///< unique in the suite
  std::string purpose;
  std::filesystem::path file;
  std::vector<std::string> groups;
  std::vector<std::pair<std::string, std::string>> point;  ///< swept keys and values, as given
  std::vector<RunResult> runs;                             ///< by seed, in the order asked for
  std::optional<Drawn> drawn = {};                         ///< of a world
};

struct SuiteResult {
  std::string detector;           ///< as asked for: lcs, lcs:lab, klt and so on
  std::vector<std::string> sets;  ///< "key=value", as given
  std::string version;            ///< of the program
  /// The earlier suite whose frames were watched, and the program that simulated them; empty where
  /// this one did.
  std::string recorded = {};
  std::vector<ScenarioResult> scenarios;
};

/// \throws bench::OutputError
void write_suite(const std::filesystem::path& file, const SuiteResult& suite);

/// The suite's folder. \param path of that, or of its file.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// \param path of the file, or of the suite's folder.
/// \throws std::runtime_error naming file and what is wrong with it.
SuiteResult read_suite(const std::filesystem::path& path);

}  // namespace lcs::suite
