/// \file
/// Parts of a suite, for several machines.
#pragma once

#include <string>
#include <vector>

namespace lcs::suite {

struct Shard {
  int part = 1, parts = 1;  ///< 1 <= part <= parts
};

/// \param text as "3/16". \throws std::invalid_argument
Shard shard_of(const std::string& text);

/// The part of each run, 1 to `parts`, such that the parts take about equally long: the longest run
/// first, each to the part with the least so far. Equal inputs give equal parts on every machine.
/// \param seconds estimated duration of each run, >= 0.
std::vector<int> parts_of(const std::vector<double>& seconds, int parts);

}  // namespace lcs::suite
