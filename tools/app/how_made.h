/// \file
/// `run.json` in a folder of results: how it was made.
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

}  // namespace lcs::app
