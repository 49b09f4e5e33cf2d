/// \file
/// Changes single values of a document.
#pragma once

#include "scenarios/input/document.h"

namespace lcs::input {

/// Sets the value of a key as `apply_set` does; null removes it. \throws Error citing `where`.
void set(Value& root, std::string_view key, Value value, const Source& where);

}  // namespace lcs::input
