/// \file
/// Commands write their results through `Output`: a file or folder appears as a whole or not at
/// all, and replaces only files that this program wrote and nobody changed since.
#pragma once

#include <filesystem>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "scenarios/input/descriptor.h"
#include "tools/files/output_file.h"

namespace lcs::files {

/// A process holds this lock while it works in a folder. The system releases it when the process
/// ends, also by SIGKILL.
class [[nodiscard]] FolderLock {
 public:
  /// Does not wait if another process holds the lock.
  /// \param is_shared opens the folder without a lock.
  explicit FolderLock(const std::filesystem::path& folder, bool is_shared = false);

  bool is_held() const { return is_held_; }
  bool is_of_another() const { return is_of_another_; }
  /// False if the file system has no such locks. Then nobody can hold one.
  bool is_possible() const { return is_possible_; }
  /// The error by which the folder cannot be opened, such as ENOENT, or ELOOP for a link; 0 if it
  /// was opened.
  int problem() const { return problem_; }

 private:
  input::Descriptor file_;
  int problem_ = 0;
  bool is_held_ = false;
  bool is_of_another_ = false;
  bool is_possible_ = true;
};

/// Paths within a folder of results. A name may start or end with `*`, which matches anything:
/// "runs/*/seed-*/metrics.json".
using ResultNames = std::vector<std::string>;

/// Whether a file, or a folder, of a folder of results may have this path in it.
bool is_name_of(const std::filesystem::path& within, const ResultNames& names,
                bool is_folder = false);

/// Removes the staging folders that killed processes left beside `target`. They have a marker. Only
/// files of these names are removed from them. If the process was killed while it replaced an
/// earlier result, and the target is missing, the earlier result is put back.
/// \param is_folder whether the target is a folder; else it is a file.
void remove_abandoned(const std::filesystem::path& target, const ResultNames& names,
                      bool is_folder = true);

/// The absolute path of an output; links in the folders above it are resolved.
/// \throws OutputError for a link, and for a path that is, contains or lies in an input of this
///   process (scenarios/input/inputs_read.h). Call it after all inputs are read.
std::filesystem::path output_path(const std::filesystem::path& named);

enum class Overwrite {
  own,            ///< only files that this program wrote and nobody changed since
  own_or_forced,  ///< as `own`; the message of a refusal names `--force`
  any_file        ///< any regular file, as `--force` asks for
};

/// \param force whether the user gave --force.
constexpr Overwrite overwrite(bool force) {
  return force ? Overwrite::any_file : Overwrite::own_or_forced;
}

/// What remains of a folder of results if its command ends before `commit`.
enum class Unfinished {
  removed,
  kept,    ///< TARGET.unfinished, after `Output::keep`: the next command goes on there
  shared,  ///< likewise, for one of several processes that fill it at once, and never commit it
};

/// Results are written into a staging folder beside the target and finally moved to the target.
/// Even if the process is killed, the target is either the earlier result or the new one.
class Output {
 public:
  /// A folder of results. Makes the staging folder, and the folders above it if they are missing.
  /// \param names of all files that a result can have. A folder is not replaced if it holds any
  ///   other file, or a file that this program did not write, or that was changed since.
  /// \throws OutputError, also as `output_path`, and for the working folder and those above it.
  /// \param wait called again and again while another process works on the target, with
  ///   `Unfinished::kept`; it may throw. If it is absent, such a process is an OutputError.
  Output(const std::filesystem::path& target, ResultNames names,
         Unfinished unfinished = Unfinished::removed, std::function<void()> wait = {});
  /// A single file. Terminals, pipes that are read, and other character devices such as /dev/null
  /// are written to directly.
  Output(const std::filesystem::path& target, Overwrite overwrite);

  /// Removes the results, unless they were committed.
  ~Output();
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;

  /// Write the results here: into an existing folder, or as a new file.
  const std::filesystem::path& staging() const { return staging_; }
  /// A folder for what is no part of the result, but is kept and removed with the staging folder.
  /// \throws OutputError
  std::filesystem::path work() const;
  /// Keeps the staging folder from now on, also if this command does not commit it. What an earlier
  /// command kept is kept anyway.
  void keep() { is_kept_ = true; }
  /// Removes what an earlier command kept in the staging folder.
  void empty();
  /// Where the results will be.
  const std::filesystem::path& target() const { return target_; }

  /// As `commit_all` for this output alone.
  void commit();

 private:
  struct Move;  ///< a new file or folder, its target, and a path for the earlier one
  friend void commit_all(std::span<Output* const> outputs);
  friend void put_in_place(std::span<Output* const> outputs);
  friend std::vector<std::filesystem::path> folders_under_way();

  bool is_folder() const { return overwrite_ == std::nullopt; }
  void prepare();
  void require_replaceable() const;
  void require_own(const std::filesystem::path& place) const;
  void require_own_folder(const std::filesystem::path& folder,
                          std::filesystem::file_type type) const;
  std::vector<Move> moves() const;
  void make_parents();
  void make_staging();
  void take_free_name(int attempt);
  void take_unfinished();
  void remove_all_made() const;

  ResultNames names_;
  std::optional<Overwrite> overwrite_;  ///< nullopt for a folder
  Unfinished unfinished_ = Unfinished::removed;
  std::function<void()> wait_;
  std::filesystem::path target_;
  std::filesystem::path own_;      ///< beside the target: the marker, and `staging_`
  std::filesystem::path staging_;  ///< in `own_`
  std::vector<std::filesystem::path> made_parents_;  ///< innermost last
  std::optional<FolderLock> lock_;                   ///< on `own_`
  bool is_direct_ = false;                           ///< a device or a pipe
  input::Descriptor pipe_;  ///< held open, so that its reader does not see an end too early
  bool is_kept_ = false;
  bool committed_ = false;
};

/// The targets and staging folders of all outputs of this process.
std::vector<std::filesystem::path> folders_under_way();

/// Moves all outputs of a command to their targets, or none of them. If there are several, a second
/// process moves them, so that a signal or `kill -9` of this process does not interrupt the moves.
/// \throws OutputError; then every earlier result is still there.
void commit_all(std::span<Output* const> outputs);

}  // namespace lcs::files
