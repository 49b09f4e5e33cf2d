/// \file
/// Progress of `lcs generate`, by which it continues after it was stopped, and by which several
/// processes share a sequence. While a sequence is made, its folder `.generate` contains the plan
/// and a record of each complete frame: its rows and the hashes of its files. A record is written
/// after the files of its frame, and by a rename, so that a process may be killed at any moment.
#pragma once

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <optional>
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
  /// \param plan a JSON object with everything on which the bytes of the sequence depend.
  /// \param before_it_is_read called with the folder, which exists then.
  /// \throws bench::OutputError for a folder that holds anything else, and as `bench::output_path`.
  Journal(const std::filesystem::path& folder, const std::string& plan,
          const std::function<void(const std::filesystem::path&)>& before_it_is_read = {});

  /// The sequence has its manifest: nothing is left to do.
  bool is_complete() const { return complete_; }

  /// Whether a frame has a record, and its files exist with the lengths of the record.
  bool is_whole(int frame) const;
  /// The number of frames that have records.
  int recorded() const;

  /// Writes the files of a frame, then its record. Does nothing if another process has finished the
  /// sequence. \throws bench::OutputError
  void add(int frame, const FrameOutput& output, const Agreements& checks) const;

  /// Writes a file of the sequence, which appears as a whole or not at all. Replaces a file of the
  /// same bytes, or of the first of them, as a stopped process leaves it.
  /// \throws bench::OutputError, also for any other file at its place, and for a link.
  void write(const std::filesystem::path& within, std::string_view bytes) const;

  /// \throws bench::OutputError if one of these files exists before `frame` is complete. They are
  /// written after all frames, so that it is a file of the user.
  void require_unwritten(const std::vector<std::filesystem::path>& within, int frame) const;

  /// \throws std::runtime_error for a frame without a record.
  FrameRecordEntry read(int frame) const;

  /// Removes the journal, but no files of the user in its folder. Call it after the manifest is
  /// written.
  void close() const;

  const std::filesystem::path& folder() const { return folder_; }

 private:
  std::filesystem::path record_file(int frame) const;
  std::filesystem::path plan_file() const;
  void take_over(const std::string& plan);
  void require_own(const std::filesystem::path& within, std::string_view bytes) const;
  void replace(const std::filesystem::path& path, std::string_view bytes) const;
  void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to,
                    std::string_view bytes) const;

  std::filesystem::path folder_;
  bool complete_ = false;
};

}  // namespace lcs::sequence
