/// \file
/// The result of a suite: the figures and criteria of each scenario and seed. It is stored as
/// `suite.json`, from which alone comparisons and tables are made.
#pragma once

#include <cstdint>
#include <filesystem>
#include <nlohmann/json_fwd.hpp>
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
  error,   ///< no figures: a broken scenario, scene, file or GL
};

/// The word for the user and in files: passed, failed or error.
const char* word_of(Outcome outcome);

struct RunResult {
  std::uint64_t seed = 0;
  Outcome outcome = Outcome::error;
  std::string command;       ///< shell command that repeats the run
  std::string error = {};    ///< the command's error message
  scoring::Metrics metrics;  ///< empty for an error
  std::vector<scoring::JudgedCriterion> criteria = {};
  std::vector<recording::Warned> warnings;  ///< with a count above 0
  std::filesystem::path folder;             ///< the run's folder, relative to the suite's
  double wall_s = 0;
};

/// How a world (scenes/worlds), a scenario from a seed, was drawn.
struct Drawn {
  std::string family;
  std::uint64_t again = 0;            ///< number of redraws after failed draws
  std::vector<std::string> features;  ///< such as kinds of objects
};

/// One scenario, or one point of the grid that it sweeps.
struct ScenarioResult {
  std::string name;  ///< unique in the suite
  std::string purpose;
  std::filesystem::path file;
  std::vector<std::string> groups;
  std::vector<std::pair<std::string, std::string>> point = {};  ///< swept keys and values, as given
  std::vector<RunResult> runs;                                  ///< one per seed, as ordered
  std::optional<Drawn> drawn = {};                              ///< only for a world
};

/// Runs by the names of their scenarios, in order, with their seeds.
using SuiteRuns = std::vector<std::pair<std::string, std::vector<std::uint64_t>>>;

struct Shard {
  int part = 1, parts = 1;  ///< 1 <= part <= parts
};

/// A part of a suite, made by `lcs suite --shard`.
struct PartOf {
  Shard shard;
  SuiteRuns whole;  ///< of the whole suite
};

/// A comparison of the runs so far (sequential.h).
struct Look {
  std::size_t runs = 0;  ///< number of runs so far
  double level = 0;      ///< the probability of a false alarm by this look's verdicts
};

/// How far a suite got that is compared with its baseline while it runs.
struct Sequential {
  Look look;                ///< the last one
  std::size_t planned = 0;  ///< number of runs of the whole suite

  bool is_stopped() const { return look.runs < planned; }
};

struct SuiteResult {
  std::string detector;           ///< its name: lcs, lcs:lab, klt and so on
  std::vector<std::string> sets;  ///< "key=value", as given
  std::string version;            ///< the program's version
  /// The earlier suite that provided the frames, and the program that simulated them; empty if this
  /// suite simulated them.
  std::string recorded = {};
  std::vector<std::string> beside = {};  ///< the detectors in beside/, in order
  std::string split = {};                ///< of its worlds; "": no worlds
  std::optional<PartOf> part_of = {};    ///< absent for a whole suite
  /// Absent if it was made as a whole. Else its comparisons have this look's level, and of a
  /// stopped suite are over its own runs alone.
  std::optional<Sequential> sequential = {};
  std::vector<ScenarioResult> scenarios = {};
};

/// The criteria of a run, as in suite.json.
nlohmann::ordered_json criteria_json(const RunResult& run);

/// \throws files::OutputError
void write_suite(const std::filesystem::path& file, const SuiteResult& suite);

/// The suite's folder. \param path the folder or its suite.json.
std::filesystem::path folder_of(const std::filesystem::path& path);

/// \param path the suite.json or its folder.
/// \throws std::runtime_error that names the file and the fault.
SuiteResult read_suite(const std::filesystem::path& path);

}  // namespace lcs::suite
