/// \file
/// Finds the intended name for a misspelled one.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lcs::input {

/// `names` by edit distance from `name`, nearest first; the sort is stable.
std::vector<std::string> nearest_first(std::string_view name, std::vector<std::string> names);

/// The nearest name, if it is near enough for `name` to be a misspelling of it.
std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& names);

}  // namespace lcs::input
