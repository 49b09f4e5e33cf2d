/// \file
/// `likeness.js` as it lies beside this file: what lays out the page.
#pragma once

#include <string_view>

namespace lcs::likeness {

extern const std::string_view kLikenessJs;

}  // namespace lcs::likeness
