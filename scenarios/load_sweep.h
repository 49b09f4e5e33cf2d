/// \file
/// The groups that a scenario belongs to, and the keys that it sweeps.
#pragma once

#include <string>
#include <vector>

#include "scenarios/document.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// \throws Error unless the value is a list of one or more names, each given once.
std::vector<std::string> read_groups(const Value& value);

/// The form alone is checked: whether a key is known and takes its values shows when a point is
/// loaded. \throws Error
std::vector<SweptKey> read_sweep(const Value& value);

}  // namespace lcs::scenario
