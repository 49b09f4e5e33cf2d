/// \file
/// Location of the scenarios and scenes that ship with the program.
#pragma once

#include <filesystem>

namespace lcs::scenario {

/// The folder `name` of the installation of the running program (PREFIX/share/lcs/ for
/// PREFIX/bin/lcs), or of the source tree for a program that is not installed.
std::filesystem::path shipped_folder(const std::filesystem::path& name);

}  // namespace lcs::scenario
