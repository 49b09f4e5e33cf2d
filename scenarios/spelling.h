/// \file
/// Which known name somebody meant.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lcs::scenario {

/// `names` by their edit distance from `name`, nearest first; equals keep their order.
std::vector<std::string> nearest_first(std::string_view name, std::vector<std::string> names);

/// The name nearest to `name`, if one is near enough to be a misspelling of it.
std::optional<std::string> nearest(std::string_view name, const std::vector<std::string>& names);

}  // namespace lcs::scenario
