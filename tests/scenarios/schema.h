/// \file
/// The JSON Schema of scenario files by `scenarios/fields.h`, from which scenario.schema.json is
/// made.
#pragma once

#include <string>

namespace lcs::scenario {

/// A JSON Schema (draft-07) of scenario files, with every key and the kind of its value. The loader
/// also checks ranges of numbers with a unit, the order of times, and that files exist.
std::string schema_text();

}  // namespace lcs::scenario
