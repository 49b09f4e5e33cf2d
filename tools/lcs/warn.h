/// \file
/// What is no error, but seldom meant, on stderr.
#pragma once

#include <fmt/format.h>

#include <string>
#include <vector>

namespace lcs::tools {

inline void warn(const std::vector<std::string>& lines) {
  for (const std::string& line : lines) tell("warning: " + line);
}

}  // namespace lcs::tools
