/// \file
/// Location of the scenarios and scenes that ship with the program.
#pragma once

#include <filesystem>

namespace lcs::scenario {

/// The program `lcs`, which also runs as child processes: the running program, unless
/// `set_program` names it.
const std::filesystem::path& program();

/// Names the program where another one runs: in a module that it loads. Call it before all other
/// functions of the project.
void set_program(std::filesystem::path file);

/// The folder `name` of the installation of the program (PREFIX/share/lcs/ for
/// PREFIX/bin/lcs), or of the source tree for a program that is not installed.
std::filesystem::path shipped_folder(const std::filesystem::path& name);

}  // namespace lcs::scenario
