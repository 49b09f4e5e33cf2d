#include "tools/suite/pattern.h"

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace lcs::suite {
namespace {

/// Limit on characters times repetitions by braces, because std::regex recurses for each.
constexpr double kMostParts = 1000;

/// The longest file name. The time of a search grows with the square of the length.
constexpr std::size_t kLongestName = 255;

double parts_of(const std::string& text) {
  double parts = static_cast<double>(text.size());
  static const std::regex kCounts(R"(\{(\d{0,9}),?(\d{0,9})\d*)");
  for (std::sregex_iterator found(text.begin(), text.end(), kCounts), end; found != end; ++found) {
    const auto count = [&](std::size_t group) {
      const std::string digits = (*found)[group].str();
      return digits.empty() ? 1.0 : std::stod(digits);
    };
    parts *= std::max({1.0, count(1), count(2)});
  }
  return parts;
}

}  // namespace

Pattern::Pattern(const std::string& text, std::string_view option, std::string_view example) {
  // Check the size before parsing.
  if (static_cast<double>(text.size()) > kMostParts || parts_of(text) > kMostParts) {
    throw std::runtime_error(
        fmt::format("{} {} repeats more than {} characters; give a part of a name, or as '{}'",
                    option, text, kMostParts, example));
  }
  try {
    // The default matching algorithm would recurse for each character of a name.
    regex_ = std::regex(text, std::regex::ECMAScript | std::regex_constants::__polynomial);
  } catch (const std::regex_error&) {
    throw std::runtime_error(
        fmt::format("{} {} is not a regular expression; give a part of a name, or as '{}'", option,
                    text, example));
  }
}

bool Pattern::is_in(std::string_view name) const {
  name = name.substr(0, kLongestName);
  return std::regex_search(name.begin(), name.end(), regex_);
}

}  // namespace lcs::suite
