/// \file
/// A folder of results that appears whole or not at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/files/output_file.h"

namespace lcs::bench {

/// A lock that says that the process working in a folder is alive: it ends with the process,
/// however that ends.
class FolderLock {
 public:
  /// Does not wait for another process that holds it.
  explicit FolderLock(const std::filesystem::path& folder);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool is_held() const { return is_held_; }
  bool is_of_another() const { return is_of_another_; }

 private:
  int file_ = -1;
  bool is_held_ = false;
  bool is_of_another_ = false;
};

/// What a folder of results consists of, and how it is told from someone else's.
struct ResultFiles {
  /// Paths within it. A name may start or end with `*`, which stands for anything:
  /// "runs/*/seed-*/metrics.json". The first one always is there.
  std::vector<std::string> names;
  /// What is found in the first file, near its beginning, and in no file of another program.
  std::string sign;
};

/// Removes the staging folders that killed processes left beside `target`, which are known by their
/// marker. Removes nothing but `files` from them, and leaves what cannot be removed. Where there is
/// no result, but an earlier one that was being replaced, puts that back.
void remove_abandoned(const std::filesystem::path& target, const ResultFiles& files);

/// Results are written into a staging folder beside the target, which takes the target's place in
/// the end. An earlier result there is replaced as a whole; anything else is never touched. At
/// whatever moment the process is killed, the target is the earlier result or the new one.
class OutputFolder {
 public:
  /// Makes the staging folder, and the folders above it where they are missing. Removes those that
  /// killed processes left.
  /// \param files that a result may consist of. A target that holds anything else, or lacks the
  ///   first of them, or has one without the sign, is not an earlier result.
  /// \throws OutputError for a target that cannot be written, holds something else, or is the
  ///   working folder.
  OutputFolder(const std::filesystem::path& target, ResultFiles files);

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
  void require_replaceable(const std::filesystem::path& folder) const;
  void make_parents();
  void make_staging();
  void remove_all_made() const;
  void replace_target();

  ResultFiles files_;
  std::filesystem::path target_;
  std::filesystem::path own_;      ///< beside the target: the marker, and `staging_`
  std::filesystem::path staging_;  ///< in `own_`
  std::vector<std::filesystem::path> made_parents_;  ///< innermost last
  std::optional<FolderLock> lock_;                   ///< on `own_`
  bool committed_ = false;
};

}  // namespace lcs::bench
