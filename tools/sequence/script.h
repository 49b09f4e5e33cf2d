/// \file
/// Runs the Python scripts of this folder, by which formats with libraries for Python are written.
#pragma once

#include <string>
#include <vector>

namespace lcs::sequence {

/// \param name of the script's file. \return its standard output.
/// \throws std::runtime_error with the message of a script that failed.
std::string run_script(const std::string& name, const std::vector<std::string>& arguments);

}  // namespace lcs::sequence
