/// \file
/// Regular expressions from the user that match names.
#pragma once

#include <regex>
#include <string>
#include <string_view>

namespace lcs::suite {

/// An ECMAScript regular expression without back-references, so that matching time is bounded.
class Pattern {
 public:
  /// \param option the option's name, such as "--filter". \param example a valid pattern.
  /// \throws std::runtime_error for an invalid expression or one with more than 1000 parts.
  Pattern(const std::string& text, std::string_view option, std::string_view example);

  /// Whether the pattern matches anywhere in the name's first 255 bytes.
  bool is_in(std::string_view name) const;

 private:
  std::regex regex_;
};

}  // namespace lcs::suite
