/// \file
/// The README.md of a generated sequence: every file, unit, frame and axis.
#pragma once

#include <string>
#include <vector>

#include "tools/sequence/writer.h"

namespace lcs::sequence {

inline constexpr const char* kReadmeFile = "README.md";

std::string readme_text(const SequenceInfo& info, const std::vector<std::string>& formats);

}  // namespace lcs::sequence
