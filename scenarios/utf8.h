/// \file
/// What is UTF-8 and what is not.
#pragma once

#include <cstddef>
#include <string_view>

namespace lcs::scenario {

/// The length of the UTF-8 sequence at the start of `bytes`, 0 when there is none (Unicode 3.9,
/// table 3-7: no overlong forms, no surrogates). \param bytes at least one.
std::size_t utf8_length(std::string_view bytes);

}  // namespace lcs::scenario
