/// \file
/// Progress of `lcs generate`, by which it continues after it was stopped, and by which several
/// processes share a sequence. While a sequence is made, its folder `.generate` contains the plan
/// and a record of each complete frame: its rows and the hashes of its files. A record is written
/// after the files of its frame, and by a rename, so that a process may be killed at any moment.
/// The folder `.generate` is made with the first record: a sequence that fails before leaves
/// nothing.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "tools/sequence/frame_output.h"
#include "tools/sequence/self_check.h"

namespace lcs::sequence {

struct FileRecord {
  std::string path;
  std::uint64_t bytes = 0;
  std::string sha256;
};

/// Agreements by the name of what was compared, as "flow_px".
using Agreements = std::map<std::string, Agreement>;

struct FrameRecordEntry {
  std::vector<FileRecord> files;
  Rows rows;
  Agreements checks;
};

class Journal {
 public:
  /// Takes over a folder that is missing, empty, or holds a sequence of the same plan.
  /// \param plan_in called with the folder, which exists then and is not yet read. It returns a
  ///   JSON object with everything on which the bytes of the sequence depend.
  /// \param adds the folder holds a finished sequence of the same plan but for its formats. Its
  ///   files stay as they are, except for README.md and the manifest, which are replaced at the
  ///   end.
  /// \throws bench::OutputError for a folder that holds anything else, and as `bench::output_path`.
  Journal(const std::filesystem::path& folder,
          const std::function<std::string(const std::filesystem::path&)>& plan_in,
          bool adds = false);
  /// Removes the folders that it made, if they are empty.
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The sequence has its manifest: nothing is left to do.
  bool is_complete() const { return complete_; }

  /// Whether a frame has a record, and its files exist with the lengths of the record.
  bool is_whole(int frame) const;
  /// The number of frames that have records.
  int recorded() const;

  /// Writes the files of a frame, then its record. Does nothing if another process has finished the
  /// sequence. \throws bench::OutputError
  void add(int frame, const FrameOutput& output, const Agreements& checks);

  /// Writes a file of the sequence, which appears as a whole or not at all. Leaves a file of the
  /// same bytes, and replaces one of the first of them, as a stopped process leaves it.
  /// \throws bench::OutputError, also for any other file at its place, and for a link.
  void write(const std::filesystem::path& within, std::string_view bytes) const;

  /// Adds the files of a folder that another program makes.
  /// \param make called with the path of a folder to make, beside which it may have other files.
  /// \throws bench::OutputError as `write`.
  std::vector<FileRecord> add_folder(
      const std::filesystem::path& within,
      const std::function<void(const std::filesystem::path&)>& make) const;

  /// \throws bench::OutputError if one of these files exists before `frame` is complete. They are
  /// written after all frames, so that it is a file of the user.
  void require_unwritten(const std::vector<std::filesystem::path>& within, int frame) const;

  /// \throws std::runtime_error for a frame without a record.
  FrameRecordEntry read(int frame) const;

  /// Removes the journal, but no files of the user in its folder. Call it after the manifest is
  /// written.
  void close() const;

  const std::filesystem::path& folder() const { return folder_; }
  const std::string& plan() const { return plan_; }

 private:
  void remove_made() const;
  std::filesystem::path record_file(int frame) const;
  std::filesystem::path plan_file() const;
  void take_over(bool adds);
  bool begin();
  bool is_there(const std::filesystem::path& within, std::string_view bytes) const;
  void replace(const std::filesystem::path& path, std::string_view bytes) const;
  void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to,
                    std::string_view bytes) const;

  std::filesystem::path folder_;
  std::string plan_;
  std::vector<std::filesystem::path> made_;  ///< the outermost folder first
  std::set<std::filesystem::path> earlier_;  ///< files of the sequence that formats are added to
  bool begun_ = false;                       ///< the folder has the plan
  bool complete_ = false;
};

}  // namespace lcs::sequence
