/// \file
/// Packs the run lengths of a mask (`sim/truth/mask.h`) into a string, in pycocotools' format.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sim/truth/mask.h"

namespace lcs::recording {

std::string packed_runs(const sim::PixelRuns& runs);

/// \return the run lengths, unchecked: they may be negative or have a wrong sum.
/// \throws std::invalid_argument for a malformed string.
std::vector<std::int64_t> unpacked_runs(std::string_view word);

}  // namespace lcs::recording
