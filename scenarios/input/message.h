/// \file
/// Makes messages printable, whatever text they quote, and validates UTF-8.
#pragma once

#include <cstddef>
#include <exception>
#include <string>
#include <string_view>
#include <vector>

namespace lcs::input {

/// Escapes (as `\x1b`) invalid UTF-8, control characters other than tabs and line ends, and
/// characters that change the direction of writing.
std::string printable(std::string_view text);

/// `printable` text in one line, with tabs as `\t`. Beyond 1000 bytes it omits the middle, because
/// messages end with the remedy.
std::string one_line(std::string_view text);

/// The words with commas in between, and another separator before the last one: "a, b or c".
std::string joined(const std::vector<std::string>& words, std::string_view last_separator);

/// An exception's message in one line. For lack of memory, file errors and other system errors it
/// adds a remedy.
std::string message_of(const std::exception& error);

/// Length of the UTF-8 sequence at the start of `bytes`; 0 if invalid (Unicode 3.9, table 3-7: no
/// overlong forms, no surrogates). \param bytes at least one.
std::size_t utf8_length(std::string_view bytes);

}  // namespace lcs::input
