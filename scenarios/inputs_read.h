/// \file
/// Which files and folders this process has read, so that no output takes the place of one.
#pragma once

#include <filesystem>
#include <vector>

namespace lcs::scenario {

/// Every file that `InputFile` opens is noted by that. Whoever reads a folder as a whole notes it.
/// May be called from any thread.
void note_input(const std::filesystem::path& path);

/// Absolute paths, each once.
std::vector<std::filesystem::path> inputs_read();

}  // namespace lcs::scenario
