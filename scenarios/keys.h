/// \file
/// Documentation of the keys of a scenario file, and its JSON Schema, generated from `fields.h`.
#pragma once

#include <string>

namespace lcs::scenario {

/// All keys for a terminal: the path of each key ("NAME" and "N" for any name and index), its
/// meaning, the effect of omitting it, and the accepted values.
std::string keys_text();

/// A JSON Schema (draft-07) of scenario files, with every key and the kind of its value. The loader
/// also checks ranges of numbers with a unit, the order of times, and that files exist.
std::string schema_text();

}  // namespace lcs::scenario
