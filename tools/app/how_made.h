/// \file
/// `run.json` in a folder of results: how it was made.
#pragma once

#include <filesystem>
#include <nlohmann/json_fwd.hpp>
#include <string>

#include "sim/simulation.h"
#include "tools/app/caller.h"

namespace lcs::app {

/// Writes command, versions, the date of the start (UTC), and seconds since, after the entries of
/// `about`. It has neither the host's name nor the user's.
/// \param command that repeats the result.
/// \param versions empty if nothing was simulated.
/// \throws bench::OutputError
void write_how_made(const std::filesystem::path& folder, const std::string& command,
                    const sim::Versions& versions, const nlohmann::ordered_json& about);

/// Begins the times of the next `write_how_made`, in a process that carries out several requests.
void note_start();

/// Warns that a shorter result will replace a longer one. \param what "frames" or "runs", an entry
/// of `about`. \param is_named whether the user named the folder, which is no default.
/// \throws bench::OutputError if the earlier result in a default folder has more than `count`.
void note_longer(const std::filesystem::path& folder, bool is_named, const char* what,
                 std::size_t count, Caller& caller);

}  // namespace lcs::app
