/// \file
/// The one way in which the program opens a file that it reads. Pipes, devices, sockets and folders
/// are refused before they are read: they may never end, or wait for ever. So is what is larger
/// than its kind of file ever is. Memory that runs out is `std::bad_alloc`, never an end of file.
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>

#include "scenarios/scenario.h"

namespace lcs::scenario {

inline constexpr std::uint64_t kMebibyte = 1 << 20;
inline constexpr std::uint64_t kGibibyte = 1 << 30;

/// What a file is read as.
struct FileKind {
  std::uint64_t most_bytes;
  std::string_view remedy;  ///< what to do about a file that cannot be read, as "give ..."
};

class InputFile {
 public:
  /// \throws Error "FILE: what is wrong; what to do"
  InputFile(const std::filesystem::path& file, const FileKind& kind);
  /// \param where the file is named, which is blamed for it.
  InputFile(const std::filesystem::path& file, const FileKind& kind, const Source& where);
  ~InputFile();
  InputFile(const InputFile&) = delete;
  InputFile& operator=(const InputFile&) = delete;

  /// All that has not been read yet. \throws Error
  std::string bytes();

  /// The next line without its line end, and the first one without a byte order mark.
  /// \return false at the end. \throws Error, also for a line of more than 256 MiB.
  bool next_line(std::string& line);

  /// Where the line is that was read last.
  Source here() const { return {file_, line_}; }

 private:
  bool fill();  ///< false at the end
  [[noreturn]] void fail(const std::string& what, std::string_view remedy) const;
  [[noreturn]] void fail(int error) const;
  void check(const struct stat& status) const;
  void check_size(std::uint64_t bytes) const;

  std::string file_;
  FileKind kind_;
  Source where_;
  int descriptor_ = -1;
  int line_ = 0;
  std::uint64_t read_ = 0;
  std::string buffer_;
  std::size_t used_ = 0;  ///< of the buffer
};

/// The whole file. \throws Error as `InputFile`.
std::string read_file(const std::filesystem::path& file, const FileKind& kind);

}  // namespace lcs::scenario
