/// \file
/// The one kind of error that tells a user what is wrong with an input, and where.
#pragma once

#include <stdexcept>
#include <string>

namespace lcs::input {

/// Source of a value, for errors that appear only later (a body that the scene lacks) but must cite
/// its line.
struct Source {
  std::string file;  ///< or an assignment such as "--set ego.speed=1"
  int line = 0;      ///< from 1; 0 means the whole file, or an assignment
};

/// The user's error message: "file:line: problem; remedy", without the line if it is unknown.
class Error : public std::runtime_error {
 public:
  Error(const Source& where, const std::string& what_and_remedy);
};

}  // namespace lcs::input
