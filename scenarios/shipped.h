/// \file
/// Where what ships with the program is: scenarios and scenes.
#pragma once

#include <filesystem>

namespace lcs::scenario {

/// `NAME/` of those that were installed with the running program (PREFIX/share/lcs/ for
/// PREFIX/bin/lcs); of the source tree for a program that was not installed.
std::filesystem::path shipped_folder(const std::filesystem::path& name);

}  // namespace lcs::scenario
