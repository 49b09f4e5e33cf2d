/// \file
/// The sets of numbers that a search has tried, with their figures. The file is created whole, and
/// from then on it is only appended to, one row in one write, so that neither `kill -9` nor a full
/// disk loses a row.
///
/// Its head states all that the figures depend on; a journal with another head is refused. Each row
/// ends with a check of the head and itself: the first digits of their SHA-256.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/tune/trials.h"

namespace lcs::tune {

inline constexpr const char* kJournalFile = "evaluations.csv";

/// A thing that the figures of a search depend on, as in {"seed", "1"}.
struct Fact {
  std::string name, text;
};

class Journal {
 public:
  /// Opens the file, or creates it where there is none. A last line without its line end, as a kill
  /// or a full disk leaves it, is not read; the next row marks it as cut off.
  /// \param facts about the search. \param keys of the numbers that it tries.
  /// \throws scenario::Error naming file and line, before anything is written: the file is no plain
  ///   file, is no journal, is one of other facts (each is named with both its texts), or has a row
  ///   that is not as it was written. bench::OutputError
  Journal(const std::filesystem::path& file, const std::vector<Fact>& facts,
          const std::vector<std::string>& keys);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// What these values came to, if they have been tried. \param values in the order of the keys
  std::optional<Worth> find(const std::vector<std::string>& values) const;

  /// The row is in the file when this returns. \throws bench::OutputError
  void add(const std::vector<std::string>& values, const Worth& worth);

 private:
  void create() const;
  void read(const std::vector<Fact>& facts);
  void read_row(const std::string& row, int line);
  std::string check_of(const std::string& row) const;
  [[noreturn]] void refuse(int line, const std::string& what) const;

  std::filesystem::path path_;
  std::size_t columns_;  ///< of a row, the check included
  std::string head_;
  bool is_cut_off_ = false;                          ///< the last line lacks its line end
  std::map<std::vector<std::string>, Worth> known_;  ///< by the values
  int file_ = -1;
};

}  // namespace lcs::tune
