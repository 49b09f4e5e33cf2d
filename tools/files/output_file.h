/// \file
/// Writes files and reports every error.
#pragma once

#include <fmt/core.h>

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace lcs::files {

/// Results cannot be written. The message states the cause and the remedy.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
  /// Formats as `fmt::format` does.
  template <class First, class... More>
  OutputError(fmt::format_string<First, More...> format, First&& first, More&&... more)
      : std::runtime_error(
            fmt::format(format, std::forward<First>(first), std::forward<More>(more)...)) {}
};

/// \throws OutputError "cannot VERB PATH: cause; remedy"
[[noreturn]] void fail_to(std::string_view verb, const std::filesystem::path& path,
                          const std::error_code& error);
[[noreturn]] void fail_to(std::string_view verb, const std::filesystem::path& path, int error);

/// Whether `path` is `folder` or lies in it. Both are normal, and absolute or relative to the same.
bool is_within(const std::filesystem::path& path, const std::filesystem::path& folder);

/// Whether a path that stands in a file of others stays in the folder that it is relative to: no
/// root, no ".." and no ".".
bool is_inner(const std::filesystem::path& path);

/// The first `bytes` bytes of a regular file; "" if there is none, also for a link.
/// \throws OutputError for a file that cannot be read.
std::string beginning(const std::filesystem::path& file, std::size_t bytes);

/// All files and folders in a folder and below. \throws OutputError
std::vector<std::filesystem::directory_entry> entries_below(const std::filesystem::path& folder);

enum class Packing { gzip, zlib };
/// \throws std::bad_alloc
std::string compressed(std::string_view bytes, Packing packing);

/// A file, created or emptied on construction. Only `close` ensures that all of it was written.
class OutputFile {
 public:
  /// \throws OutputError
  explicit OutputFile(const std::filesystem::path& path);

  /// \throws OutputError, for example if the disk is full.
  void write(std::string_view text);
  /// Flushes and closes the file. \throws OutputError
  void close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// A text file that may be compressed: as gzip members of about a mebibyte, so that neither memory
/// nor the loss by a broken byte grows with the file.
class TextFile {
 public:
  /// \param compressed appends ".gz" to the path. \throws OutputError
  TextFile(std::filesystem::path path, bool compressed);
  /// \throws OutputError
  void write(std::string_view text);
  /// \throws OutputError
  void close();

 private:
  void flush();

  bool compressed_;
  OutputFile file_;
  std::string pending_;  ///< not yet compressed
};

/// Copies a regular file, not through a link.
/// \throws std::runtime_error for a file that cannot be read; OutputError
void copy_bytes(const std::filesystem::path& from, const std::filesystem::path& to);

/// Makes `to` the same file as `from`, or a copy on another file system. \throws as `copy_bytes`
void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to);

/// Waits until a file's or folder's content is on the disk. \throws OutputError
void flush_to_disk(const std::filesystem::path& path);

/// Writes a whole file. \throws OutputError
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lcs::files
