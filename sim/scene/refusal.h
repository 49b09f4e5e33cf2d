/// \file
/// MuJoCo's messages in the words of this program.
#pragma once

#include <string>

namespace lcs::sim {

/// MuJoCo's message in one line, with a remedy: "problem; remedy".
/// \param more appended to the problem, for example " (body 'ball')".
std::string in_one_line(const std::string& said, const std::string& more = "");

}  // namespace lcs::sim
