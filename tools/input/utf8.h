/// \file
/// Validation of UTF-8.
#pragma once

#include <cstddef>
#include <string_view>

namespace lcs::input {

/// Length of the UTF-8 sequence at the start of `bytes`; 0 if invalid (Unicode 3.9, table 3-7: no
/// overlong forms, no surrogates). \param bytes at least one.
std::size_t utf8_length(std::string_view bytes);

}  // namespace lcs::input
