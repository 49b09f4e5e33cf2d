/// \file
/// Messages as people read them, whatever is quoted in them.
#pragma once

#include <exception>
#include <string>
#include <string_view>

namespace lcs::scenario {

/// As it is where it is UTF-8 that shows; what it is not, control characters (but for tabs and line
/// ends) and what turns the direction of writing is escaped, as \x1b.
std::string printable(std::string_view text);

/// `printable` text in one line; of more than 1000 bytes the beginning and the end, where the
/// remedy is.
std::string one_line(std::string_view text);

/// What an exception says, as one line; for what a library throws, what is wrong and what to do.
std::string message_of(const std::exception& error);

}  // namespace lcs::scenario
