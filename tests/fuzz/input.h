/// \file
/// Shared parts of the fuzzers: bytes read in sequence, numbers at edge cases, texts as files, and
/// the failure of an invariant.
#pragma once

#include <unistd.h>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <span>
#include <string>
#include <string_view>

namespace lcs::fuzz {

/// Aborts the program, as libFuzzer expects.
[[noreturn]] inline void fail(const std::string& what) {
  std::fprintf(stderr, "does not hold: %s\n", what.c_str());
  std::abort();
}
inline void require(bool holds, const char* what) {
  if (!holds) fail(what);
}

/// The bytes of an input in sequence; 0 after its end.
class Bytes {
 public:
  Bytes(const std::uint8_t* data, std::size_t size) : rest_(data, size) {}

  bool empty() const { return rest_.empty(); }
  std::uint8_t byte() {
    if (rest_.empty()) return 0;
    const std::uint8_t first = rest_.front();
    rest_ = rest_.subspan(1);
    return first;
  }
  std::int16_t word() {
    const unsigned low = byte(), high = byte();
    return static_cast<std::int16_t>(low | high << 8);
  }
  /// Usually within a few times `unit`; one in 32 is an edge case.
  double number(double unit) {
    const std::uint8_t kind = byte();
    if (kind < 248) return unit * (static_cast<double>(word()) / 8192);
    static constexpr std::array<double, 16> kTempting = {
        std::numeric_limits<double>::quiet_NaN(),
        std::numeric_limits<double>::infinity(),
        -std::numeric_limits<double>::infinity(),
        std::numeric_limits<double>::max(),
        -std::numeric_limits<double>::max(),
        std::numeric_limits<double>::min(),
        std::numeric_limits<double>::denorm_min(),
        0.0,
        -0.0,
        1e3,
        -1e3,
        1e9,
        -1e9,
        1e-9,
        59.9,
        1e30,
    };
    return kTempting[byte() % kTempting.size()];
  }

 private:
  std::span<const std::uint8_t> rest_;
};

/// A separate folder for each process, in RAM if possible.
inline const std::filesystem::path& work_folder() {
  struct Folder {
    Folder() {
      namespace fs = std::filesystem;
      const fs::path shared_memory = "/dev/shm";
      const fs::path home =
          ::access(shared_memory.c_str(), W_OK) == 0 ? shared_memory : fs::temp_directory_path();
      path = home / ("lcs-fuzz-" + std::to_string(::getpid()));
      fs::create_directories(path);
    }
    ~Folder() {
      std::error_code ignored;
      std::filesystem::remove_all(path, ignored);
    }
    std::filesystem::path path;
  };
  static const Folder folder;
  return folder.path;
}

inline void write_file(const std::filesystem::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary);
  stream << text;
  stream.close();
  require(stream.good(), "the disk takes a small file");
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

/// Writes those sections of an input whose name is one of `files` into a folder. A section follows
/// a line "=== NAME".
inline void write_sections(const std::filesystem::path& folder, std::span<const char* const> files,
                           std::string_view text) {
  namespace fs = std::filesystem;
  constexpr std::string_view kMark = "=== ";
  fs::remove_all(folder);
  fs::create_directories(folder);
  for (std::size_t mark = text.find(kMark); mark != text.npos; mark = text.find(kMark)) {
    text.remove_prefix(mark + kMark.size());
    const std::size_t line = std::min(text.find('\n'), text.size());
    const std::string_view name = text.substr(0, line);
    text.remove_prefix(std::min(line + 1, text.size()));
    if (std::find(files.begin(), files.end(), name) == files.end()) continue;
    fs::create_directories((folder / name).parent_path());
    write_file(folder / name, text.substr(0, text.find(kMark)));
  }
}

}  // namespace lcs::fuzz
