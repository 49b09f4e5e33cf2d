/// \file
/// The search for the filter's learnt parameters: NLopt's BOBYQA (Powell, "The BOBYQA Algorithm for
/// Bound Constrained Optimization without Derivatives", 2009) on the logarithm of each. It fits a
/// quadratic model, which takes about twice as many evaluations as there are parameters.
///
/// Its output files, besides the journal of its evaluations (tools/files/journal.h): the preset,
/// and the record of its origin.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "filter/parameters.h"
#include "tools/files/journal.h"
#include "tools/recording/recording.h"

namespace lcs::tune {

/// Means over the runs, with equal weight for each run.
struct Worth {
  double f1 = 0;            ///< over the worlds with movers
  double false_moving = 0;  ///< false objects per frame, over these worlds
  double false_static = 0;  ///< false objects per frame, over the static worlds
  /// False objects per frame over all worlds, with at most 1 per frame for each world.
  double false_capped = 0;
  double false_corners = 0;  ///< false corners per frame, over static recordings

  /// The objective that `lcs tune` maximizes: F1 less 0.1 per false object per frame, less 0.01 per
  /// false corner per frame of recordings, which have more of them than worlds.
  double objective() const { return f1 - 0.1 * false_capped - 0.01 * false_corners; }
};

/// The figures of a set of filter parameters on recorded runs: a new filter processes the recorded
/// frames, and the result is scored like every run.
class Trials {
 public:
  /// Reads the runs of suites (`lcs suite`) of worlds or recordings.
  /// \param suites folders of suites, or their suite.json files.
  /// \throws std::runtime_error with the folder: no suite, a run without truth or signatures, a run
  ///   that changes while it is read, or a run of the split `test`, which must not be tuned on.
  explicit Trials(const std::vector<std::string>& suites);

  /// Uses all cores; the result does not depend on their number.
  /// \param tick called between two runs; an exception ends the work.
  Worth worth(
      const Parameters& parameters, const std::function<void()>& tick = [] {}) const;

  const std::vector<recording::Recording>& runs() const { return runs_; }

 private:
  void read(const std::filesystem::path& suite);

  std::vector<recording::Recording> runs_;
};

inline constexpr const char* kEvaluationsFile = "evaluations.csv";

/// The evaluations of a search: each evaluated set of parameter values and its figures, in a
/// journal.
class Evaluations {
 public:
  /// Opens or creates the file.
  /// \param provenance all facts and files that the figures depend on. \param keys of the searched
  ///   parameters. \throws as `files::Journal`; input::Error for a row of other numbers.
  Evaluations(const std::filesystem::path& file, const files::Provenance& provenance,
              const std::vector<std::string>& keys);

  /// The figures of these values; absent if not evaluated yet. \param values in the order of keys.
  std::optional<Worth> find(const std::vector<std::string>& values) const;

  /// Appends a row; it is in the file when this returns. \throws files::OutputError
  void add(const std::vector<std::string>& values, const Worth& worth);

 private:
  std::map<std::vector<std::string>, Worth> known_;
  files::Journal journal_;
};

/// A parameter's key and its value in the form that `set` accepts.
struct Setting {
  std::string key, value;
};

/// A searched parameter and its bounds: a quarter to four times its present value, within its
/// range.
struct Axis {
  std::string key;
  double start = 0, low = 0, high = 0;
};

/// \throws std::invalid_argument for a key that is unknown or given twice, or whose value is not a
///   number above 0.
std::vector<Axis> axes_of(const Parameters& start, const std::vector<std::string>& keys);

struct SearchOptions {
  std::vector<Axis> axes;
  int evaluations = 0;  ///< at most, including evaluations of the search that it resumes
  /// 1 starts from the present values; any other seed from a random point near them. Equal results
  /// from several starts indicate a true optimum.
  std::uint64_t seed = 1;
};

struct Found {
  std::vector<Setting> before, after;  ///< by key; `after` has the best ones found
  Worth worth_before, worth_after;
  int evaluations = 0;
};

using Judge = std::function<Worth(const Parameters&)>;

/// Adds the facts about the search itself to the facts of a provenance.
void add_facts(files::Json& facts, const SearchOptions& options);

/// \param known receives each evaluation. Evaluations that it already holds are not repeated.
///   The search is deterministic, so an interrupted search resumes at the same point.
/// \param tick called after each evaluation with the number so far; an exception ends the search.
/// \throws files::OutputError
Found search(const Parameters& start, const SearchOptions& options, const Judge& judge,
             Evaluations& known, const std::function<void(int)>& tick);

inline constexpr const char* kPresetFile = "learnt.h";
inline constexpr const char* kRecordFile = "record.md";

/// The figures of the values before and after the search on one suite.
struct Stated {
  std::string suite;  ///< such as "out/train, 60 runs, corridor_1 to yard_10"
  Worth before, after;
};

/// Date, program version and command of a search.
struct Circumstances {
  std::string date, program;
  std::vector<std::string> command;  ///< its words after `lcs`
};

/// The text of `filter/types/learnt.h`, which gives the preset `default` these parameters.
std::string preset_text(const Found& found, const Circumstances& circumstances);

std::string record_text(const Found& found, const std::vector<Stated>& stated,
                        const Circumstances& circumstances);

}  // namespace lcs::tune
