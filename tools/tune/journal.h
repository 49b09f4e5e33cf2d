/// \file
/// The journal of a search: each evaluated set of parameter values and its figures. The file is
/// created atomically and then only appended to, one write per row, so that neither `kill -9` nor a
/// full disk loses a row.
///
/// The head states all facts that the figures depend on. A journal with a different head is
/// rejected. Each row ends with a checksum, the first digits of the SHA-256 of head and row.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "tools/tune/trials.h"

namespace lcs::tune {

inline constexpr const char* kJournalFile = "evaluations.csv";

/// A fact that the figures of a search depend on, such as {"seed", "1"}.
struct Fact {
  std::string name, text;
};

class Journal {
 public:
  /// Opens or creates the file. A last line without a line end, left by a kill or a full disk, is
  /// ignored; the next row marks it as cut off.
  /// \param facts about the search. \param keys of the searched parameters.
  /// \throws input::Error with file and line, before anything is written: the file is not a
  ///   regular file, not a journal, has different facts (the message lists each with both texts),
  ///   or has a row with a wrong checksum. bench::OutputError
  Journal(const std::filesystem::path& file, const std::vector<Fact>& facts,
          const std::vector<std::string>& keys);
  ~Journal();
  Journal(const Journal&) = delete;
  Journal& operator=(const Journal&) = delete;

  /// The figures of these values; absent if not evaluated yet. \param values in the order of keys.
  std::optional<Worth> find(const std::vector<std::string>& values) const;

  /// Appends a row; it is in the file when this returns. \throws bench::OutputError
  void add(const std::vector<std::string>& values, const Worth& worth);

 private:
  void create() const;
  void read(const std::vector<Fact>& facts);
  void read_row(const std::string& row, int line);
  std::string check_of(const std::string& row) const;
  [[noreturn]] void refuse(int line, const std::string& what) const;

  std::filesystem::path path_;
  std::size_t columns_;  ///< per row, including the checksum
  std::string head_;
  bool is_cut_off_ = false;  ///< the last line lacks its line end
  std::map<std::vector<std::string>, Worth> known_;
  int file_ = -1;
};

}  // namespace lcs::tune
