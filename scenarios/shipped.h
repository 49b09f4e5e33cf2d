/// \file
/// Location of the scenarios and scenes that ship with the program.
#pragma once

#include <filesystem>
#include <optional>

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

/// The scenario file of the project with this name, such as "crossing"; absent if there is none or
/// the name has a folder or an extension. \throws std::runtime_error if a file or folder called so,
/// or so with .yaml, is in the current folder too: it would be unclear which is meant; or
/// if nothing is called so, and the name of a scenario is near.
std::optional<std::filesystem::path> shipped_scenario(const std::filesystem::path& name);

}  // namespace lcs::scenario
