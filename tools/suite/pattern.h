/// \file
/// Regular expressions that a user gives, for names.
#pragma once

#include <regex>
#include <string>
#include <string_view>

namespace lcs::suite {

/// ECMAScript's, without references back to groups, so that none takes for ever.
class Pattern {
 public:
  /// \param option that it is given by, as "--filter". \param example of a pattern that fits.
  /// \throws std::runtime_error for what is no regular expression, or repeats more than 1000 parts.
  Pattern(const std::string& text, std::string_view option, std::string_view example);

  /// Whether a part of the name's first 255 bytes fits.
  bool is_in(std::string_view name) const;

 private:
  std::regex regex_;
};

}  // namespace lcs::suite
