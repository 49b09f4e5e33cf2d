/// \file
/// The files and folders that this process has read, so that no output overwrites an input.
#pragma once

#include <filesystem>
#include <vector>

namespace lcs::input {

/// Records an input. `InputFile` records each file that it opens; code that reads a whole folder
/// must record it. Thread-safe.
void note_input(const std::filesystem::path& path);

/// Absolute paths without duplicates.
std::vector<std::filesystem::path> inputs_read();

/// Forgets all of them, in a process that carries out several requests one after another.
void forget_inputs();

}  // namespace lcs::input
