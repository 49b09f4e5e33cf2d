/// \file
/// `lcs --version`.
#pragma once

#include <string>

namespace lcs::tools {

/// This program and the libraries whose version can change a result. Starts GL to ask it.
/// \throws std::runtime_error when GL will not start.
std::string version_text();
/// `version_text` in one line.
std::string version_line();

/// This program's version and the commit that it was built from, as "0.1.0 (f2f2c60)", or
/// "0.1.0 (f2f2c60, changed since)" of files that differ from the commit's; outside a checkout
/// "unknown" stands for the commit.
std::string program_text();

}  // namespace lcs::tools
