/// \file
/// `lcs --version`.
#pragma once

#include <string>

namespace lcs::app {

/// The versions of this program and of the libraries that affect results. Starts GL to query it.
/// \throws std::runtime_error if GL does not start.
std::string version_text();
/// `version_text` as one line.
std::string version_line();

/// This program's version and the commit it was built from, such as "0.1.0 (f2f2c60)", or
/// "0.1.0 (f2f2c60, changed since)" if the files differ from the commit. Outside a checkout
/// the commit is "unknown".
std::string program_text();

/// Whether the commit alone says what this program does: it is known, and no file was changed
/// since.
bool is_of_a_commit();

/// The SHA-256 of the running program's file.
std::string program_sha256();

}  // namespace lcs::app
