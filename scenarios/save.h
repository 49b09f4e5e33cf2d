/// \file
/// Converts a scenario to a YAML document; the inverse of `load.h`.
#pragma once

#include "scenarios/scenario.h"
#include "tools/input/document.h"

namespace lcs::scenario {

/// The keys that differ from their defaults, for `yaml_text`. Numbers have 12 digits. Paths are
/// unchanged; a reader resolves relative paths against the file's folder.
input::Value document_of(const Scenario& scenario);

}  // namespace lcs::scenario
