/// \file
/// `lcs --version`.
#pragma once

#include <string>

namespace lcs::tools {

/// This program and the libraries whose version can change a result. Starts GL to ask it.
/// \throws std::runtime_error when GL will not start.
std::string version_text();

}  // namespace lcs::tools
