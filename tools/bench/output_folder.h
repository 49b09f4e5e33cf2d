/// \file
/// A folder of results that appears whole or not at all.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "tools/bench/output_file.h"

namespace lcs::bench {

/// Results are written into a staging folder beside the target, which takes the target's place in
/// the end. An earlier result there is replaced as a whole; anything else is never touched.
class OutputFolder {
 public:
  /// Makes the staging folder, and the folders above it where they are missing.
  /// \param files that a result may consist of, as paths within it. A name may start or end with
  ///   `*`, which stands for anything: "runs/*/seed-*/metrics.json". A target that holds anything
  ///   else, or lacks the first of them, is not an earlier result.
  /// \throws OutputError for a target that cannot be written, or holds something else.
  OutputFolder(const std::filesystem::path& target, std::vector<std::string> files);

  /// Removes what was written, unless it was committed.
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// Where to write.
  const std::filesystem::path& staging() const { return staging_; }
  /// Where the results will be: absolute, links resolved.
  const std::filesystem::path& target() const { return target_; }

  /// Puts the results in their place. \throws OutputError; then an earlier result is still there.
  void commit();

 private:
  void require_replaceable() const;
  bool is_own(const std::filesystem::path& within, bool is_folder) const;
  void make_parents();

  std::vector<std::string> files_;
  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> made_parents_;  ///< innermost last
  bool committed_ = false;
};

}  // namespace lcs::bench
