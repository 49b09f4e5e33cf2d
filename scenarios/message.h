/// \file
/// Messages as people read them, whatever is quoted in them.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace lcs::scenario {

/// The text with all escaped (as \x1b) that does not print: what is not UTF-8, control characters
/// other than tabs and line ends, and those that change the direction of writing.
std::string printable(std::string_view text);

/// `printable` text in one line. Of more than 1000 bytes the middle is left out, as messages end
/// with what to do.
std::string one_line(std::string_view text);

/// What an exception says, in one line; of too little memory, files and other calls of the system
/// also what to do.
std::string message_of(const std::exception& error);

}  // namespace lcs::scenario
