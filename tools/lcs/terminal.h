/// \file
/// Standard output and standard error.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lcs::tools {

/// Opens those of the descriptors 0, 1 and 2 on /dev/null that are closed, so that no file that is
/// opened later takes their place and what is printed ends in it.
void open_standard_descriptors();

/// To standard output. \throws bench::OutputError, and Interrupted where nobody reads it and a signal
/// asks to end.
void write_out(const std::string& text);
/// To standard error; what cannot be written there is lost.
void write_err(const std::string& text);

/// To standard error: one line that a terminal shows as it is, whatever is quoted in it.
void tell(std::string_view message);
/// Prints warnings to standard error, a line each.
void warn(const std::vector<std::string>& lines);

template <class... Args>
void print_out(fmt::format_string<Args...> format, Args&&... args) {
  write_out(fmt::format(format, std::forward<Args>(args)...));
}
template <class... Args>
void print_err(fmt::format_string<Args...> format, Args&&... args) {
  write_err(fmt::format(format, std::forward<Args>(args)...));
}

/// Writes out what is still buffered, by anybody. \throws as `write_out`.
void finish_out();

}  // namespace lcs::tools
