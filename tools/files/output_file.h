/// \file
/// Writes files and reports every error.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace lcs::bench {

/// Results cannot be written. The message states the cause and the remedy.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// \throws OutputError "cannot VERB PATH: cause; remedy"
[[noreturn]] void fail_to(std::string_view verb, const std::filesystem::path& path,
                          const std::error_code& error);
[[noreturn]] void fail_to(std::string_view verb, const std::filesystem::path& path, int error);

/// The first `bytes` bytes of a regular file; "" for anything else, including a link.
std::string beginning(const std::filesystem::path& file, std::size_t bytes);

/// A file, created or emptied on construction. Only `close` ensures that all of it was written.
class OutputFile {
 public:
  /// \throws OutputError
  explicit OutputFile(const std::filesystem::path& path);

  /// \throws OutputError, for example if the disk is full.
  void write(std::string_view text);
  /// Passes the buffer to the operating system, so that the data survives if this process is
  /// killed. \throws OutputError
  void flush();
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

/// Makes `to` the same file as `from`, or a copy on another file system.
/// \throws std::filesystem::filesystem_error
void link_or_copy(const std::filesystem::path& from, const std::filesystem::path& to);

/// Writes a whole file. \throws OutputError
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lcs::bench
