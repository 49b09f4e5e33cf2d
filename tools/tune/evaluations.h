/// \file
/// The evaluations of a search: each evaluated set of parameter values and its figures, in a
/// journal (tools/files/journal.h).
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/journal.h"
#include "tools/tune/trials.h"

namespace lcs::tune {

inline constexpr const char* kEvaluationsFile = "evaluations.csv";

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

}  // namespace lcs::tune
