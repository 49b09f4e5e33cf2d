/// \file
/// A journal of finished units of work, such as evaluations or frames, by which stopped work goes
/// on. The file is only appended to, one write a row, so that neither `kill -9` nor a full disk
/// loses a row. Its head has the provenance of the work. Each row ends with a checksum, the first
/// digits of the SHA-256 of head and row.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

#include "scenarios/input/descriptor.h"
#include "tools/files/provenance.h"

namespace lcs::files {

/// Reads a journal, also while a process writes it.
class JournalReader {
 public:
  using Take = std::function<void(const std::string& row, int line)>;

  /// \param sign the first line. \param remedy for a file that does not fit.
  JournalReader(std::filesystem::path file, std::string_view sign, std::string remedy);

  /// Reads the head, unless it was read before. \return false if it is not whole yet.
  /// \throws input::Error with file and line, if the file is no such journal.
  bool read_head();
  /// The head, with its line ends, and the provenance in it. After `read_head`.
  const std::string& head() const { return head_; }
  const Provenance& provenance() const { return provenance_; }

  /// Calls `take` for each row that was added since the last call. A last line without a line end,
  /// which a kill or a full disk leaves, is not taken.
  /// \throws input::Error as `read_head`, for a row with a wrong checksum, and what `take` throws.
  void read(const Take& take);
  /// The bytes of the head and of the rows that were read.
  std::size_t size() const { return used_; }

  [[noreturn]] void refuse(int line, const std::string& what) const;

 private:
  /// From a byte on, with at least so many line ends if there are.
  std::string text_from(std::size_t begin, std::ptrdiff_t lines) const;

  std::filesystem::path file_;
  std::string sign_, remedy_, head_;
  Provenance provenance_;
  std::size_t used_ = 0;
  int line_ = 0;
};

/// Appends rows to a journal. One process at a time.
class Journal {
 public:
  /// Creates the file, or goes on with it. What a kill left of a last row is removed.
  /// \param sign first line. \param columns third line, behind the provenance.
  /// \param take gets the rows that are there.
  /// \throws input::Error, before anything is written, if the file is a link, no such journal, of
  ///   another provenance, or has a row with a wrong checksum. OutputError
  Journal(std::filesystem::path file, std::string_view sign, const Provenance& provenance,
          std::string_view columns, std::string remedy, const JournalReader::Take& take);

  /// Appends a row without line ends; it is in the file when this returns, or not at all.
  /// \throws OutputError
  void add(std::string_view row);

 private:
  void append(std::string_view text);

  std::filesystem::path path_;
  std::string head_;
  std::size_t size_ = 0;  ///< bytes
  input::Descriptor file_;
};

}  // namespace lcs::files
