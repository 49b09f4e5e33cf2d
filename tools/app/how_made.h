/// \file
/// `run.json` in a folder of results: how it was made; and `lcs --version`.
#pragma once

#include <filesystem>
#include <string>

#include "sim/simulation.h"
#include "tools/app/caller.h"
#include "tools/files/provenance.h"

namespace lcs::app {

/// Adds the program and the versions of its libraries to the facts of a provenance.
/// \param versions empty if nothing was simulated.
void add_program(files::Json& facts, const sim::Versions& versions);
/// Adds the SHA-256 of a program that was built from changed files, which its commit does not tell.
/// For work that goes on or is joined.
void add_changed_program(files::Json& facts);

/// Writes the command, the provenance, the date of the start (UTC), and seconds since. The file has
/// neither the host's name nor the user's.
/// \param command that repeats the result.
/// \throws files::OutputError
void write_how_made(const std::filesystem::path& folder, const std::string& command,
                    const files::Provenance& provenance);

/// Begins the times of the next `write_how_made`, in a process that carries out several requests.
void note_start();

/// Warns that a shorter result will replace a longer one. \param what "frames" or "runs", an entry
/// of `about`. \param is_named whether the user named the folder, which is no default.
/// \throws files::OutputError if the earlier result in a default folder has more than `count`.
void note_longer(const std::filesystem::path& folder, bool is_named, const char* what,
                 std::size_t count, Caller& caller);

/// The versions of this program and of the libraries that affect results. Starts GL to query it.
/// \throws std::runtime_error if GL does not start.
std::string version_text();
/// `version_text` as one line.
std::string version_line();

/// This program's version and the commit it was built from, such as "0.1.0 (f2f2c60)", or
/// "0.1.0 (f2f2c60, changed since)" if the files differ from the commit. Outside a checkout
/// the commit is "unknown".
std::string program_text();

/// The SHA-256 of the running program's file.
std::string program_sha256();

}  // namespace lcs::app
