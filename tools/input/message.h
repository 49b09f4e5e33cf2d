/// \file
/// Makes messages printable, whatever text they quote.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace lcs::input {

/// Escapes (as `\x1b`) invalid UTF-8, control characters other than tabs and line ends, and
/// characters that change the direction of writing.
std::string printable(std::string_view text);

/// `printable` text in one line, with tabs as `\t`. Beyond 1000 bytes it omits the middle, because
/// messages end with the remedy.
std::string one_line(std::string_view text);

/// An exception's message in one line. For lack of memory, file errors and other system errors it
/// adds a remedy.
std::string message_of(const std::exception& error);

}  // namespace lcs::input
