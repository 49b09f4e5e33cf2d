/// \file
/// A scenario as a YAML document: the way back from `load.h`.
#pragma once

#include "scenarios/document.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// The keys that differ from their defaults, for `yaml_text`. Numbers have 12 digits. Paths stay as
/// they are; when they are read again, relative ones begin at the file.
Value document_of(const Scenario& scenario);

}  // namespace lcs::scenario
