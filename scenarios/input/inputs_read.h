/// \file
/// The files and folders that this process has read, with the digest of each file: so that no
/// output overwrites an input, and so that a result can state the files that determined it
/// (tools/files/provenance.h).
#pragma once

#include <filesystem>
#include <map>
#include <string>

namespace lcs::input {

/// Records an input, and the SHA-256 of a file when it is recorded for the first time. `InputFile`
/// records each file that it opens. Code that lets a library open a file, or that reads a whole
/// folder, must record it. Thread-safe. \throws Error for a file that cannot be read.
void note_input(const std::filesystem::path& path);

/// Digests by absolute path; "" for a folder, and if there was no file.
std::map<std::filesystem::path, std::string> inputs_read();

/// Forgets all of them, in a process that carries out several requests one after another. Requests
/// that run at the same time in one process share one record.
void forget_inputs();

}  // namespace lcs::input
