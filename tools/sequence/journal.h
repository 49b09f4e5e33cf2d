/// \file
/// Which frames of a sequence are whole. While a sequence grows, its folder has a folder
/// `.generate` with the plan, and with a record for each frame that is whole: rows, and the hashes
/// of its files. A record is the last that is written of a frame, and appears in one piece, so that
/// a process may be killed at any moment, and several may work on one sequence.
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
  /// \param plan a JSON object that says all that the bytes of the sequence depend on.
  /// Takes over a folder that is missing, empty, or holds a sequence that was begun by the same
  /// plan. \throws bench::OutputError for a folder that holds anything else, and as
  /// `bench::output_path`.
  /// \param before_it_is_read called with the folder, which is there then.
  Journal(const std::filesystem::path& folder, const std::string& plan,
          const std::function<void(const std::filesystem::path&)>& before_it_is_read = {});

  /// The sequence is there with its manifest: nothing is to be done.
  bool is_complete() const { return complete_; }

  /// Whether a frame has a record, and its files are there, as long as it says.
  bool is_whole(int frame) const;
  /// How many frames have records.
  int recorded() const;

  /// Writes the files of a frame, then its record; nothing where another process has put the
  /// sequence together meanwhile. \throws bench::OutputError
  void add(int frame, const FrameOutput& output, const Agreements& checks) const;

  /// Writes a file of the sequence, which appears whole or not at all; until then it is in the
  /// journal, which takes it along. A file that is there with the same bytes, or with the first of
  /// them, was left by a process that was stopped. \throws bench::OutputError, also where there is
  /// any other file, or a link, which is left as it is.
  void write(const std::filesystem::path& within, std::string_view bytes) const;

  /// \throws bench::OutputError where one of these files is there before `frame` is whole. They are
  /// written when all frames are, so that it is not of the sequence.
  void require_unwritten(const std::vector<std::filesystem::path>& within, int frame) const;

  /// \throws std::runtime_error for a frame without a record.
  FrameRecordEntry read(int frame) const;

  /// Takes the journal away, but nothing else that somebody put there, when all that it tells of is
  /// in the manifest.
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
