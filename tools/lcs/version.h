/// \file
/// `lcs --version`.
#pragma once

#include <string>

namespace lcs::tools {

/// This program and the libraries whose version can change a result. Starts GL to ask it.
/// \throws std::runtime_error when GL will not start.
std::string version_text();

/// This program's version and the commit that it was built from, as "0.1.0 (f2f2c60)"; "-dirty"
/// follows the commit when files were changed since, and "unknown" stands for it outside a
/// checkout.
std::string program_text();

}  // namespace lcs::tools
