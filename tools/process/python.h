/// \file
/// Runs a script that ships with the program by Python.
#pragma once

#include <filesystem>
#include <span>
#include <string>

namespace lcs::process {

struct PythonEnd {
  bool is_fine = false;  ///< it exited with 0
  std::string out, err;  ///< its texts
};

/// Runs a script to its end by the Python that the environment's LCS_PYTHON names, or by python3.
/// \param out a file descriptor for its standard output; below 0: `PythonEnd::out`.
/// \throws std::system_error
PythonEnd run_python(const std::filesystem::path& script, std::span<const std::string> arguments,
                     int out = -1);

}  // namespace lcs::process
