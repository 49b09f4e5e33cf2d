/// \file
/// The runs of a mask (`sim/mask.h`) packed into one word, as pycocotools writes them.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim/mask.h"

namespace lcs::bench {

std::string packed_runs(const sim::Runs& runs);

/// The numbers in the word, unchecked: they may be negative or not add up. \throws
/// std::invalid_argument
std::vector<std::int64_t> unpacked_runs(std::string_view word);

}  // namespace lcs::bench
