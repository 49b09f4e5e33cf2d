/// \file
/// Documentation of the keys of a scenario file, and the keys of a scenario: both by `fields.h`.
#pragma once

#include <string>

#include "scenarios/input/document.h"
#include "scenarios/scenario.h"

namespace lcs::scenario {

/// All keys for a terminal: the path of each key ("NAME" and "N" for any name and index), its
/// meaning, the effect of omitting it, and the accepted values.
std::string keys_text();

/// The keys of a scenario that differ from their defaults, for `yaml_text`; the inverse of
/// `load.h`. Numbers have 12 digits. Paths are unchanged; a reader resolves relative paths against
/// the file's folder.
input::Value document_of(const Scenario& scenario);

}  // namespace lcs::scenario
