/// \file
/// A file being written, with every error reported.
#pragma once

#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <string_view>
#include <system_error>

namespace lcs::bench {

/// Results cannot be written: says why, and what to do about it.
class OutputError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// What to do about an error of writing.
std::string remedy(const std::error_code& error);

/// The first bytes of a plain file; "" for anything else.
std::string beginning(const std::filesystem::path& file, std::size_t bytes);
/// Whether a plain file has `sign` near its beginning.
bool has_sign(const std::filesystem::path& file, std::string_view sign);

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
  [[noreturn]] void fail(int error) const;

  std::filesystem::path path_;
  std::unique_ptr<std::FILE, Closer> file_;
};

/// A whole file at once. \throws OutputError
void write_file(const std::filesystem::path& path, std::string_view bytes);

/// Ends the names of files that `write_whole` has not finished: "metrics.json.1234.partial".
inline constexpr const char* kUnfinished = ".partial";
/// The name that such a file gets when it is finished.
std::filesystem::path finished_name(const std::filesystem::path& unfinished);

/// Writes a file that appears whole or not at all: `write` is given a path beside it to write to. A
/// pipe, /dev/stdout, or whatever else is there and no plain file, is written to directly.
/// \param sign that an earlier file must have, unless it is empty, in order to be replaced.
/// \throws OutputError, and what `write` throws; then an earlier file is as it was.
void write_whole(const std::filesystem::path& path,
                 const std::function<void(const std::filesystem::path&)>& write,
                 std::string_view sign = "");
/// The same of these bytes.
void write_whole(const std::filesystem::path& path, std::string_view bytes,
                 std::string_view sign = "");

}  // namespace lcs::bench
