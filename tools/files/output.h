/// \file
/// The one way in which commands write what a user names: a file or a folder that appears whole or
/// not at all, and that never takes the place of anything but this program's own, unchanged files.
#pragma once

#include <filesystem>
#include <optional>
#include <span>
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

/// Paths within a folder of results. A name may start or end with `*`, which stands for anything:
/// "runs/*/seed-*/metrics.json".
using ResultNames = std::vector<std::string>;

/// Removes the staging folders that killed processes left beside `target`, which are known by their
/// marker. Removes nothing but files of such names from them, and leaves what cannot be removed.
/// Where the target is missing and an earlier one was being replaced, puts that back.
void remove_abandoned(const std::filesystem::path& target, const ResultNames& names);

/// The place that a path names: absolute, the links of the folders above it resolved.
/// \throws OutputError for a link, and for a path that is an input of this process, lies inside
/// one,
///   or holds one (scenarios/inputs_read.h). All inputs have to be read before.
std::filesystem::path output_path(const std::filesystem::path& named);

enum class Overwrite {
  own,            ///< only files that this program wrote and nobody changed since
  own_or_forced,  ///< likewise, and the message of a refusal names `--force`
  any_file        ///< with `--force`: any regular file
};

/// Results are written into a staging folder beside the target, and take the target's place in the
/// end. At whatever moment the process is killed, the target is the earlier result or the new one.
class Output {
 public:
  /// A folder of results. Makes the staging folder, and the folders above it where they are
  /// missing. \param names of the files that a result may consist of. A folder that holds any other
  /// file, or
  ///   one that this program did not write, or that was changed since, is not replaced.
  /// \throws OutputError, also as `output_path`, and for the working folder and those above it.
  Output(const std::filesystem::path& target, ResultNames names);
  /// A single file. A terminal, /dev/null, a pipe that is read, and other character devices are
  /// written to directly.
  Output(const std::filesystem::path& target, Overwrite overwrite);

  /// Removes what was written, unless it was committed.
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  /// Where to write: a folder that is there, or a file that is not.
  const std::filesystem::path& staging() const { return staging_; }
  /// Where the results will be.
  const std::filesystem::path& target() const { return target_; }

  /// As `commit_all` of this one.
  void commit();

 private:
  struct Move;  ///< something new, its place, and where the earlier one goes
  friend void commit_all(std::span<Output* const> outputs);
  friend void put_in_place(std::span<Output* const> outputs);

  bool is_folder() const { return overwrite_ == std::nullopt; }
  void prepare();
  void require_replaceable() const;
  void require_own(const std::filesystem::path& place) const;
  void require_own_folder(const std::filesystem::path& folder,
                          std::filesystem::file_type type) const;
  std::vector<Move> moves() const;
  void make_parents();
  void make_staging();
  void remove_all_made() const;

  ResultNames names_;
  std::optional<Overwrite> overwrite_;  ///< none: a folder
  std::filesystem::path target_;
  std::filesystem::path own_;      ///< beside the target: the marker, and `staging_`
  std::filesystem::path staging_;  ///< in `own_`
  std::vector<std::filesystem::path> made_parents_;  ///< innermost last
  std::optional<FolderLock> lock_;                   ///< on `own_`
  bool is_direct_ = false;                           ///< a device or a pipe
  int pipe_ = -1;  ///< held open, so that its reader does not see an end too early
  bool committed_ = false;
};

/// Puts all outputs of a command in their places: all of them, or none. A second process does so
/// where there are several, so that a signal or a `kill -9` of this one does not come in between.
/// \throws OutputError; then every earlier result is still there.
void commit_all(std::span<Output* const> outputs);

}  // namespace lcs::bench
