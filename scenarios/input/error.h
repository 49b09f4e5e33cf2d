/// \file
/// The one kind of error that tells a user what is wrong with an input, and where.
#pragma once

#include <fmt/core.h>

#include <filesystem>
#include <stdexcept>
#include <string>
#include <utility>

/// The short name of all code that reads and writes files.
namespace lcs {
namespace fs = std::filesystem;
}

namespace lcs::input {

/// Source of a value, for errors that appear only later (a body that the scene lacks) but must cite
/// its line.
struct Source {
  std::string file;  ///< or an assignment such as "--set ego.speed=1"
  int line = 0;      ///< from 1; 0 means the whole file, or an assignment
};

/// "FILE:LINE", without the line if it is unknown.
std::string text_of(const Source& where);

/// The user's error message: "file:line: problem; remedy", without the line if it is unknown.
class Error : public std::runtime_error {
 public:
  Error(const Source& where, const std::string& what_and_remedy);

  /// Formats problem and remedy as `fmt::format` does.
  template <class First, class... More>
  Error(const Source& where, fmt::format_string<First, More...> format, First&& first,
        More&&... more)
      : Error(where, fmt::format(format, std::forward<First>(first), std::forward<More>(more)...)) {
  }
};

}  // namespace lcs::input
