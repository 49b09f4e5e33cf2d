/// \file
/// The only way to open an input file. Pipes, devices, sockets and folders are rejected before
/// reading, because reading might never end. Files beyond the size limit of their kind are
/// rejected, too. A file NAME.gz is decompressed (gzip). Exhausted memory throws `std::bad_alloc`
/// and is never an end of file.
#pragma once

#include <sys/stat.h>

#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <string_view>

#include "scenarios/input/descriptor.h"
#include "scenarios/input/error.h"

namespace lcs::input {

inline constexpr std::uint64_t kMebibyte = 1 << 20;
inline constexpr std::uint64_t kGibibyte = 1 << 30;

/// A kind of input file.
struct FileKind {
  std::uint64_t most_bytes;
  std::string_view remedy;  ///< for an unreadable file, for example "give ..."
};

class InputFile {
 public:
  /// \throws Error "FILE: problem; remedy"
  InputFile(const std::filesystem::path& file, const FileKind& kind);
  /// \param where the place that names the file; errors cite it.
  InputFile(const std::filesystem::path& file, const FileKind& kind, const Source& where);

  /// The bytes not yet read. \throws Error
  std::string bytes();

  /// Up to `count` bytes from a place in the file, which no other call changes; fewer at its end.
  /// Not of a compressed file. \throws Error
  std::string bytes_at(std::uint64_t offset, std::size_t count) const;

  /// Reads the next line without its line end, and without a byte order mark at the file's start.
  /// \return false at the end. \throws Error, also for a line of more than 256 MiB.
  bool next_line(std::string& line);

  /// Place of the last line read.
  Source here() const { return {file_, line_}; }

 private:
  bool fill();        ///< reads a block; false at the end
  bool read_block();  ///< of the file
  bool decompress();  ///< the next member of a gzip file; false at the end
  [[noreturn]] void fail(const std::string& what, std::string_view remedy) const;
  [[noreturn]] void fail(int error) const;
  void check(const struct stat& status) const;
  void check_size(std::uint64_t bytes) const;

  std::string file_;
  FileKind kind_;
  Source where_;
  Descriptor descriptor_;
  int line_ = 0;
  std::uint64_t read_ = 0;
  bool is_gzip_ = false;
  std::string compressed_;          ///< a gzip file's bytes, once they are read
  std::size_t decompressed_ = 0;    ///< number of these bytes used
  std::unique_ptr<char[]> member_;  ///< room for a member, which need not be zeroed
  std::size_t room_ = 4 * kMebibyte;
  std::string buffer_;
  std::size_t used_ = 0;  ///< bytes of the buffer already returned
};

/// The content of the whole file. \throws Error as `InputFile`.
std::string read_file(const std::filesystem::path& file, const FileKind& kind);

}  // namespace lcs::input
