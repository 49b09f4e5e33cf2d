/// \file
/// The `recording` of a scenario.
#pragma once

#include <array>
#include <filesystem>

#include "scenarios/reader.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// The words of `Recorded::Split`, in its order.
inline constexpr std::array<const char*, 3> kSplits{"train", "validate", "test"};

/// \param folder that paths begin at.
Recorded read_recording(Reader reader, const std::filesystem::path& folder);

}  // namespace lcs::scenario
