/// \file
/// A folder of results that appears whole or not at all.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "tools/bench/output_file.h"

namespace lcs::bench {

/// Says of a folder that its process lives: however that ends, the lock ends with it.
class FolderLock {
 public:
  /// Waits for another process that holds it, if it is to `wait`.
  FolderLock(const std::filesystem::path& folder, bool wait);
  ~FolderLock();
  FolderLock(const FolderLock&) = delete;
  FolderLock& operator=(const FolderLock&) = delete;

  bool is_held() const { return is_held_; }
  /// Whether this is the folder of that name; it may have been replaced.
  bool is_of(const std::filesystem::path& folder) const;

 private:
  int file_ = -1;
  bool is_held_ = false;
};

/// Takes away what processes left beside `target` that were killed on the way to it. What cannot be
/// taken away stays.
void remove_abandoned(const std::filesystem::path& target);

/// Results are written into a staging folder beside the target, which takes the target's place in
/// the end. An earlier result there is replaced as a whole; anything else is never touched. At
/// whatever moment the process is killed, the target is the earlier result or the new one.
class OutputFolder {
 public:
  /// Makes the staging folder, and the folders above it where they are missing. Takes away those of
  /// processes that were killed.
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
  void make_staging();
  void remove_staging() const;

  std::vector<std::string> files_;
  std::filesystem::path target_;
  std::filesystem::path staging_;
  std::vector<std::filesystem::path> made_parents_;  ///< innermost last
  std::optional<FolderLock> lock_;                   ///< on the staging folder
  bool committed_ = false;
};

}  // namespace lcs::bench
