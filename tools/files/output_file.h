/// \file
/// A file being written, with every error reported.
#pragma once

#include <cstdio>
#include <filesystem>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace lcs::bench {

/// Results cannot be written. The message says why, and what to do.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// \throws OutputError "cannot VERB PATH: why; what to do"
[[noreturn]] void fail_to(std::string_view verb, const std::filesystem::path& path,
                          const std::error_code& error);
[[noreturn]] void fail_to(std::string_view verb, const std::filesystem::path& path, int error);

/// The first bytes of a regular file, at most so many; "" for anything else, a link included.
std::string beginning(const std::filesystem::path& file, std::size_t bytes);

/// Created (or emptied) on construction. Only `close` tells whether all of it was written.
class OutputFile {
 public:
  /// \throws OutputError
  explicit OutputFile(const std::filesystem::path& path);

  /// \throws OutputError, as when the disk is full.
  void write(std::string_view text);
  /// Hands what was written so far to the system, so that it is there even if this process is
  /// killed. \throws OutputError
  void flush();
  /// Writes out what is still buffered. \throws OutputError
  void close();

 private:
  struct Closer {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };
  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// A whole file at once. \throws OutputError
void write_file(const std::filesystem::path& path, std::string_view bytes);

}  // namespace lcs::bench
