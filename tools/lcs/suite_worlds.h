/// \file
/// The worlds that a suite runs, drawn where they are not there yet.
#pragma once

#include <string>
#include <vector>

namespace lcs::tools {

struct WorldsOptions {
  std::string split;  ///< "": no worlds
  int count = 60;
  std::string family;  ///< "": all
};

/// Makes the worlds in out/worlds/, each by a process of its own, `jobs` at a time.
/// \return their scenario files, family by family.
/// \throws std::invalid_argument for an unknown split or family, Interrupted, std::runtime_error.
std::vector<std::string> make_worlds(const WorldsOptions& options, std::size_t jobs);

}  // namespace lcs::tools
